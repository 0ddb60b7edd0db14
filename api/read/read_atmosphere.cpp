#include "api/read_atmosphere.h"

#include "api/fields/atmosphere_fields.h"
#include "api/json/parse_json.h"
#include "api/read/read_fields.h"
#include "renderer/description/check_atmosphere.h"

namespace api {

void ReadFields::preset(const char* name, renderer::AtmosphereDescription& atmosphere, const char* doc)
{
    word(name, atmosphere.preset, doc);
    atmosphere = renderer::atmosphere_preset(atmosphere.preset);
}

std::variant<renderer::AtmosphereDescription, ProblemDetails>
read_atmosphere(std::string_view json, std::optional<renderer::AtmospherePreset> preset)
{
    const ReadContext context;
    auto parsed = parse_json(json, context.limits);
    if (const auto* problem = std::get_if<ProblemDetails>(&parsed)) return *problem;
    Json& root = std::get<Json>(parsed);
    if (preset && root.is_object())
        root["preset"] = name_of(words_for<renderer::AtmospherePreset>(), static_cast<int>(*preset));

    JobRequest none;
    ReadState state{context, none};
    std::variant<renderer::AtmosphereDescription> read;
    ReadFields::read_alone(root, state, read);
    auto& atmosphere = std::get<renderer::AtmosphereDescription>(read);
    for (renderer::Fault& fault : renderer::check_atmosphere(atmosphere, ""))
        if (!state.faults.touches(fault.pointer))
            state.faults.add(std::move(fault.pointer), std::move(fault.code), std::move(fault.detail));
    if (!state.faults.empty()) return problem_from_faults(422, "invalid_scene", state.faults.take());
    return atmosphere;
}

} // namespace api
