// States as SQL writes them: StoredState's numbers by name.
#pragma once

#include "server/store/store.h"

#include <initializer_list>
#include <string>

namespace server {

inline std::string sql_of(StoredState state)
{
    return std::to_string(static_cast<int>(state));
}

// "0, 1": for IN (...).
inline std::string sql_of(std::initializer_list<StoredState> states)
{
    std::string list;
    for (const StoredState state : states)
        list += (list.empty() ? "" : ", ") + sql_of(state);
    return list;
}

inline const std::string kQueued = sql_of(StoredState::queued);
inline const std::string kLeased = sql_of(StoredState::leased);
inline const std::string kSucceeded = sql_of(StoredState::succeeded);
inline const std::string kCanceled = sql_of(StoredState::canceled);
inline const std::string kExpired = sql_of(StoredState::expired);
inline const std::string kOpen = sql_of({StoredState::queued, StoredState::leased});
// Final, and not yet expired.
inline const std::string kEnded =
    sql_of({StoredState::succeeded, StoredState::failed, StoredState::canceled});
// Final, without a result.
inline const std::string kWithoutResult =
    sql_of({StoredState::failed, StoredState::canceled, StoredState::expired});

} // namespace server
