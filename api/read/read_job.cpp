// From bytes to a job: parse, walk every member, then the rules that join several members.
#include "api/fields/job_fields.h"
#include "api/job_request.h"
#include "api/json/parse_json.h"
#include "api/json/pointer.h"
#include "api/read/read_fields.h"
#include "api/words/limit_words.h"
#include "api/words/sentences.h"
#include "renderer/description/check_atmosphere.h"

#include <algorithm>
#include <utility>

namespace api {

namespace {

bool may_stand_in_label(char c)
{
    const auto byte =
        static_cast<unsigned char>(c); // `char` has a sign on some processors and none on others
    return c != ':' && byte != 127 && byte >= ' ';
}

} // namespace

void ReadFields::labels(std::map<std::string, std::string>& labels)
{
    const Json* node = find("labels");
    if (!node) return;
    if (!node->is_object()) return wrong_type(at("labels"), "an object of strings", *node);
    if (node->size() > kMostLabels)
        return fault(at("labels"),
                     "wrong_length",
                     std::to_string(node->size()) + " labels are more than " + std::to_string(kMostLabels));
    for (const auto& [name, value] : node->items()) {
        const std::string pointer = pointer_to(at("labels"), name);
        if (!name_fits(pointer, name)) continue;
        if (!std::all_of(name.begin(), name.end(), may_stand_in_label)) {
            fault(pointer,
                  "bad_name",
                  "a label's name has no colon, which ends it where labels are asked for, and no control "
                  "characters");
            continue;
        }
        if (const std::string* text = text_at(value, pointer, 0, kLongestLabel)) labels[name] = *text;
    }
}

void ReadFields::fail_on(std::vector<std::string>& words)
{
    const Json* node = array_of("fail_on", nullptr);
    for (std::size_t i = 0; node && i < node->size(); ++i) {
        const std::string* text = text_at((*node)[i], at("fail_on", i), 1, kLongestName);
        if (!text || !word_at(at("fail_on", i), *text, fail_on_words())) continue;
        if (std::find(words.begin(), words.end(), *text) != words.end())
            fault(at("fail_on", i), "conflict", in_quotes(*text) + " stands twice");
        else
            words.push_back(*text);
    }
}

void ReadFields::layers(renderer::LayerSet& layers)
{
    const Json* node = array_of("layers", nullptr);
    for (std::size_t i = 0; node && i < node->size(); ++i) {
        const std::string* text = text_at((*node)[i], at("layers", i), 1, kLongestName);
        const Word* word = text ? word_at(at("layers", i), *text, layer_words()) : nullptr;
        if (!word) continue;
        const auto layer = static_cast<renderer::Layer>(word->value);
        if (layers.has(layer)) fault(at("layers", i), "conflict", in_quotes(*text) + " stands twice");
        layers.add(layer);
    }
}

namespace {

void check_not_empty(const renderer::SceneDescription& scene, FaultList& faults)
{
    const bool dark =
        !scene.environment || std::holds_alternative<renderer::NoEnvironment>(*scene.environment);
    if (!scene.objects.empty() || !dark || faults.touches("/scene")) return;
    faults.add(
        "/scene", "empty_scene", "there is nothing to see: give at least one object, or an environment");
}

void check_air(const renderer::SceneDescription& scene, FaultList& faults)
{
    const auto* const air =
        scene.environment ? std::get_if<renderer::AtmosphereDescription>(&*scene.environment) : nullptr;
    if (air == nullptr) return;
    for (renderer::Fault& fault : renderer::check_atmosphere(*air, "/scene/environment"))
        if (!faults.touches(fault.pointer))
            faults.add(std::move(fault.pointer), std::move(fault.code), std::move(fault.detail));
}

void check_spot_lights(const renderer::SceneDescription& scene, FaultList& faults)
{
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const auto* spot = std::get_if<renderer::SpotLight>(&scene.lights[i]);
        if (!spot || spot->inner_deg <= spot->outer_deg) continue;
        const std::string pointer = pointer_to("/scene/lights", i);
        if (faults.touches(pointer_to(pointer, "inner_deg")) ||
            faults.touches(pointer_to(pointer, "outer_deg")))
            continue;
        faults.add(pointer_to(pointer, "inner_deg"),
                   "out_of_range",
                   text_of(spot->inner_deg) + " is over outer_deg, " + text_of(spot->outer_deg) +
                       ": the inner cone lies within the outer");
    }
}

void check_image(const renderer::ImageSettings& image, const renderer::Limits& limits, FaultList& faults)
{
    if (faults.touches("/image/width") || faults.touches("/image/height") || faults.touches("/image/region"))
        return;
    if (image.region) {
        const renderer::PixelRect& region = *image.region;
        const bool inside = std::uint64_t(region.x) + region.width <= image.width_px &&
                            std::uint64_t(region.y) + region.height <= image.height_px;
        if (!inside)
            return faults.add("/image/region",
                              "out_of_range",
                              "it reaches beyond the picture of " + std::to_string(image.width_px) + " x " +
                                  std::to_string(image.height_px) +
                                  " pixels: x + width and y + height must fit");
    }
    const std::uint64_t pixels = image.region ? std::uint64_t(image.region->width) * image.region->height
                                              : std::uint64_t(image.width_px) * image.height_px;
    if (pixels > limits.image_pixels) faults.add(over_limit("/image", "image_pixels", pixels, limits));
}

// Where the request names no goal, the default one; never more than the service allows.
void settle_quality(renderer::QualitySettings& quality, const renderer::Limits& limits)
{
    const auto at_most = [&](std::uint32_t samples) {
        return static_cast<std::uint32_t>(std::min<std::uint64_t>(samples, limits.samples));
    };
    if (!quality.samples && !quality.time_s) quality.samples = at_most(renderer::kDefaultSamples);
    quality.max_samples = at_most(quality.max_samples);
}

// A meter makes no picture: its pixels are the replicates of one measurement.
void settle_meter(JobRequest& job, FaultList& faults)
{
    constexpr std::uint32_t kSide = 4;
    if (!job.scene.camera || job.scene.camera->projection != renderer::Projection::meter) return;
    job.settings.image.width_px = job.settings.image.height_px = kSide;
    job.settings.image.region.reset();
    if (!job.settings.image.layers.empty())
        faults.add("/image/layers", "conflict", "a meter makes no picture that layers could lie beside");
}

// "unsupported" where the request is right and the build lacks what it asks for.
ProblemDetails refusal(std::vector<Problem> faults)
{
    const bool right =
        std::all_of(faults.begin(), faults.end(), [](const Problem& f) { return f.code == "unsupported"; });
    return problem_from_faults(422, right ? "unsupported" : "invalid_scene", std::move(faults));
}

} // namespace

std::variant<JobRequest, ProblemDetails> read_job(std::string_view json, const ReadContext& context)
{
    const auto parsed = parse_json(json, context.limits);
    if (const auto* problem = std::get_if<ProblemDetails>(&parsed)) return *problem;

    JobRequest job;
    ReadState state{context, job};
    ReadFields root(std::get<Json>(parsed), "", state);
    fields(root, job);
    root.finish();

    if (std::get<Json>(parsed).is_object()) check_not_empty(job.scene, state.faults);
    check_spot_lights(job.scene, state.faults);
    settle_meter(job, state.faults);
    check_air(job.scene, state.faults);
    check_image(job.settings.image, context.limits, state.faults);
    settle_quality(job.settings.quality, context.limits);
    if (!state.faults.empty()) return refusal(state.faults.take());
    return job;
}

} // namespace api
