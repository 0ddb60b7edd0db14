#include "server/jobs/sharing.h"

#include <algorithm>
#include <utility>

namespace server {

Sharing sharing_of(const api::JobRequest& request, std::string render_key, bool no_cache)
{
    const auto& fail_on = request.fail_on;
    return {.render_key = std::move(render_key),
            .takes_results = !no_cache,
            .fails_on_non_finite = std::find(fail_on.begin(), fail_on.end(), "non_finite") != fail_on.end()};
}

bool may_reuse_stored(const Sharing& sharing)
{
    return sharing.takes_results && !sharing.fails_on_non_finite;
}

} // namespace server
