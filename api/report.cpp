#include "api/job_view.h"
#include "api/json/json.h"
#include "api/words/word_table.h"

#include <stdexcept>

namespace api {

namespace {

const char* name_of(renderer::StopReason reason)
{
    switch (reason) {
    case renderer::StopReason::samples:
        return "samples";
    case renderer::StopReason::time:
        return "time";
    }
    return "samples";
}

const char* name_of(renderer::UpperLevel level)
{
    switch (level) {
    case renderer::UpperLevel::none:
        return "none";
    case renderer::UpperLevel::built:
        return "built";
    case renderer::UpperLevel::refitted:
        return "refitted";
    }
    return "none";
}

Json choices(const std::vector<renderer::ModelChoice>& models)
{
    Json json = Json::array();
    for (const renderer::ModelChoice& model : models)
        json.push_back({{"name", model.name}, {"why", model.why}});
    return json;
}

// `met`: whether the request's own goal was reached. Samples are counted; the best picture in a time has no
// mark to miss.
Json accuracy_json(const renderer::AccuracyReport& accuracy, const renderer::QualitySettings& requested)
{
    Json json{{"requested", Json::object()},
              {"samples", accuracy.samples},
              {"estimate", nullptr},
              {"met", nullptr},
              {"stop_reason", name_of(accuracy.stop_reason)}};
    if (requested.samples) {
        json["requested"]["samples"] = *requested.samples;
        json["met"] = accuracy.samples >= *requested.samples;
    }
    if (requested.time_s) {
        json["requested"]["time_s"] = *requested.time_s;
        json["requested"]["max_samples"] = requested.max_samples;
    }
    return json;
}

Json meter_json(const renderer::MeterReading& meter)
{
    const auto color = [](renderer::Rgb c) {
        return Json::array({shortest_double(c.r), shortest_double(c.g), shortest_double(c.b)});
    };
    return {
        {"quantity", api::name_of(words_for<renderer::MeterQuantity>(), static_cast<int>(meter.quantity))},
        {"value", color(meter.value)},
        {"standard_error", color(meter.standard_error)},
        {"replicates", meter.replicates}};
}

} // namespace

std::string write_report(const renderer::RenderReport& report,
                         const std::string& job_id,
                         const std::string& render_key,
                         const renderer::QualitySettings& requested,
                         bool pretty)
{
    const renderer::NumericsReport& numerics = report.numerics;
    const renderer::TimingReport& timing = report.timing;
    const renderer::GeometryReport& geometry = report.geometry;
    Json json{
        {"job_id", job_id},
        {"render_key", render_key},
        {"accuracy", accuracy_json(report.accuracy, requested)},
        {"models", {{"used", choices(report.models.used)}, {"skipped", choices(report.models.skipped)}}},
        {"numerics",
         {{"non_finite_samples", numerics.non_finite_samples},
          {"degenerate_triangles", numerics.degenerate_triangles},
          {"coordinate_ratio", numerics.coordinate_ratio},
          {"precision", numerics.precision},
          {"clamped", numerics.clamped},
          {"cut_weight", numerics.cut_weight}}},
        {"timing",
         {{"prepare_s", timing.prepare_s},
          {"render_s", timing.render_s},
          {"camera_rays", timing.camera_rays},
          {"shadow_rays", timing.shadow_rays},
          {"bounce_rays", timing.bounce_rays},
          {"threads", report.threads}}},
        {"geometry",
         {{"triangles", geometry.triangles},
          {"instances", geometry.instances},
          {"bvh_bytes", geometry.bvh_bytes},
          {"upper_level", name_of(geometry.upper_level)}}},
        {"notes", report.notes}};
    if (report.sky) json["sky"] = {{"table_error", report.sky->table_error}};
    if (report.meter) json["meter"] = meter_json(*report.meter);
    return text_of(json, pretty);
}

std::string write_plan(const renderer::PlanReport& plan, bool pretty)
{
    const renderer::Prediction& p = plan.prediction;
    const Json json{
        {"models", {{"used", choices(plan.models.used)}, {"skipped", choices(plan.models.skipped)}}},
        {"prediction",
         {{"camera_rays", p.camera_rays},
          {"rays", p.rays},
          {"memory_bytes", p.memory_bytes},
          {"seconds", p.seconds},
          {"threads", p.threads}}}};
    return text_of(json, pretty);
}

std::string indented(const std::string& text)
{
    const Json json = Json::parse(text, nullptr, false);
    return json.is_discarded() ? text : text_of(json, true);
}

std::string readdress_report(const std::string& report, const std::string& job_id)
{
    Json json = Json::parse(report, nullptr, false);
    if (!json.is_object() || !json.contains("job_id"))
        throw std::invalid_argument("a stored report is no JSON object with a job_id");
    json["job_id"] = job_id;
    return text_of(json, true);
}

} // namespace api
