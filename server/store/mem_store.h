// MemStore: the Store in memory: the conformance suite's twin, and the store of unit tests.
#pragma once

#include "server/store/store.h"

#include <memory>

namespace server {

std::unique_ptr<Store> make_mem_store(StoreClock clock = {});

} // namespace server
