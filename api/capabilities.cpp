#include "api/documents.h"
#include "api/job_request.h"
#include "api/json/json.h"
#include "api/words/limit_words.h"
#include "api/words/word_table.h"
#include "renderer/description/layers.h"

#include <algorithm>

namespace api {

namespace {

Json limits_json(const renderer::Limits& limits)
{
    Json json = Json::object();
    for (const renderer::LimitEntry& entry : renderer::limit_table())
        json[entry.name] = {{"value", limits.*entry.value},
                            {"unit", entry.unit},
                            {"flag", flag_of(entry.name)},
                            {"environment", environment_of(entry.name)},
                            {"what", entry.what}};
    return json;
}

std::vector<std::string> shapes()
{
    std::vector<std::string> names = names_of(words_for<renderer::Shape>());
    names.insert(names.begin(), "mesh");
    return names;
}

Json models_json()
{
    return {{"cameras", names_of(words_for<renderer::Projection>())},
            {"shapes", shapes()},
            {"materials", names_of(words_for<renderer::Material>())},
            {"phong_forms", names_of(words_for<renderer::PhongForm>())},
            {"lights", names_of(words_for<renderer::Light>())},
            {"environments", names_of(words_for<renderer::Environment>())},
            {"transports", names_of(words_for<renderer::TransportType>())}};
}

// Of each layer, the formats that hold it.
Json layers_json()
{
    Json layers = Json::object();
    for (const renderer::LayerEntry& entry : renderer::kLayers) {
        Json& formats = layers[std::string(entry.name)] = Json::array();
        for (const renderer::PictureFormatEntry& format : renderer::kPictureFormats)
            if (renderer::holds(format.format, entry.layer)) formats.push_back(format.media_type);
    }
    return layers;
}

Json formats_json()
{
    return {{"meshes", names_of(mesh_format_words())},
            {"textures", names_of(texture_format_words())},
            {"images", names_of(image_format_words())},
            {"layers", layers_json()},
            {"tones", names_of(words_for<renderer::Tone>())}};
}

// A job that says nothing, as the reader fills it; and one of each alternative, whose members have defaults
// too.
Json defaults_json(const renderer::Limits& limits)
{
    ReadContext context{.limits = limits, .local = true};
    const auto read =
        read_job(R"({"scene": {"camera": {}, "objects": [{"mesh": "mesh.obj"}, {"shape": "rectangle"},
        {"shape": "disk"}, {"shape": "box"}, {"shape": "sphere"}], "materials": {"diffuse": {"type": "diffuse"},
        "phong": {"type": "phong"}}, "lights": [{"type": "point"}, {"type": "spot"}, {"type": "directional"}],
        "environment": {"type": "color"}}})",
                 context);
    const auto* job = std::get_if<JobRequest>(&read);
    return job ? Json::parse(write_job(*job), nullptr, false) : Json();
}

} // namespace

std::string write_capabilities(const renderer::Limits& limits)
{
    return text_of({{"limits", limits_json(limits)},
                    {"models", models_json()},
                    {"formats", formats_json()},
                    {"acceleration",
                     {{"splits", names_of(words_for<renderer::BvhSplit>())},
                      {"widths", names_of(words_for<renderer::BvhWidth>())},
                      {"levels", names_of(words_for<renderer::BvhLevels>())}}},
                    {"quality", {"samples", "time_s", "max_samples"}},
                    {"fail_on", names_of(fail_on_words())},
                    {"defaults", defaults_json(limits)}},
                   true);
}

} // namespace api
