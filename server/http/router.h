// Router: the one table of routes, from which 404, 405 with Allow, OPTIONS and the check of query keys are
// made, and against which openapi.json is held.
//
// Threads  add() before the first dispatch(), which any thread may call.
// Errors   dispatch() is the catch site around all handlers: the log gets the exception in full, the client a
//          public sentence and the request id.
#pragma once

#include "server/http/exchange.h"
#include "server/log/log.h"

#include <functional>
#include <string>
#include <vector>

namespace server {

using Handler = std::function<void(Exchange&)>;

struct Route {
    std::string method;             // GET answers HEAD too
    std::string pattern;            // "/v1/jobs/{id}/image"
    std::vector<std::string> query; // keys that it knows
    Handler handler;
};

class Router {
public:
    explicit Router(const Log& log) : log_(log) {}

    void add(Route route);
    const std::vector<Route>& routes() const { return routes_; }
    void dispatch(Exchange& exchange) const;

private:
    void route(Exchange& exchange) const;

    const Log& log_;
    std::vector<Route> routes_;
};

} // namespace server
