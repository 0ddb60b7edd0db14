// run_service: the composition root: opens the data folder, joins the rooms, serves until a signal, stops in
// order.
//
// Errors  StoreError and std::system_error when it cannot start: folder held by another, port taken, store
// damaged.
#pragma once

#include "server/app/options.h"
#include "server/app/stop_signals.h"

#include <iosfwd>

namespace server {

// One line with the URLs goes to `out` once it answers. Returns the exit code.
int run_service(const ServiceOptions& options, const StopSignals& signals, std::ostream& out);

} // namespace server
