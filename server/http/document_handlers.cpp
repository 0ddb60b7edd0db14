#include "server/http/document_handlers.h"

#include "api/documents.h"

namespace server {

void DocumentHandlers::add_routes(Router& router)
{
    const auto document = [&router](const char* path, auto write) {
        router.add({"GET", path, {}, [write](Exchange& exchange) {
                        reply_json(exchange, 200, std::string(write()));
                    }});
    };
    document("/", [] { return api::write_discovery(); });
    document("/v1/version", [] { return api::write_version(); });
    document("/v1/capabilities", [this] { return api::write_capabilities(limits_); });
    document("/v1/openapi.json", [] { return api::openapi_json(); });
    add_health_routes(router);
}

void DocumentHandlers::add_health_routes(Router& router)
{
    router.add({"GET", "/healthz", {}, [](Exchange& exchange) {
                    reply_json(exchange, 200, api::write_health(true, {}));
                }});
    router.add({"GET", "/readyz", {}, [this](Exchange& exchange) { ready(exchange); }});
}

void DocumentHandlers::ready(Exchange& exchange)
{
    std::string reason;
    try {
        if (jobs_.draining())
            reason = "draining: the service stops and takes no new jobs";
        else if (store_.storage_full())
            reason = "storage_full: the disk is full; no job is taken or started until there is room";
        else
            store_.depth();
    } catch (const StoreError& error) {
        reason =
            error.storage_full ? "storage_full: the disk is full" : "storage: the job store does not answer";
    }
    exchange.response.set_header("Cache-Control", "no-store");
    reply_json(exchange, reason.empty() ? 200 : 503, api::write_health(reason.empty(), reason));
}

} // namespace server
