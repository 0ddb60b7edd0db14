#include "api/provenance.h"

#include "api/build_info.h"

#include <nlohmann/json.hpp>

namespace api {

std::vector<ProvenanceText>
provenance_of(const JobRequest& request, const std::string& render_key, std::uint32_t samples)
{
    if (!request.provenance) return {};
    const BuildInfo& build = build_info();
    const nlohmann::json facts{
        {"render_key", render_key}, {"samples", samples}, {"seed", request.settings.seed}};
    return {{"Software", "heliograph " + build.version + " (" + build.commit + ")"},
            {"heliograph", facts.dump()}};
}

} // namespace api
