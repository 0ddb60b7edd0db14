#include "api/job_view.h"
#include "api/provenance.h"
#include "clients/cli/files.h"
#include "clients/cli/layer_files.h"
#include "clients/cli/local_commands.h"
#include "clients/cli/local_job.h"
#include "clients/cli/output_format.h"
#include "clients/cli/progress_bar.h"
#include "clients/cli/user_error.h"
#include "renderer/accel/prepared_mesh.h"
#include "renderer/film/encode_layer.h"
#include "renderer/film/encode_picture.h"
#include "renderer/render.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>

namespace clients {
namespace {

// The request under the command's options, read again as a job: so options meet the same checks as a scene
// does.
api::JobRequest with_options(api::JobRequest request,
                             const RenderOptions& options,
                             renderer::LayerSet layers,
                             const JobSource& source)
{
    renderer::RenderSettings& settings = request.settings;
    if (options.width_px) settings.image.width_px = *options.width_px;
    if (options.height_px) settings.image.height_px = *options.height_px;
    if (options.samples || options.time_s) {
        settings.quality.samples = options.samples;
        settings.quality.time_s = options.time_s;
    }
    settings.image.layers.bits |= layers.bits;
    if (options.seed) settings.seed = *options.seed;
    if (options.threads) settings.acceleration.threads = *options.threads;
    if (options.tile_px) settings.acceleration.tile_px = *options.tile_px;
    if (options.split) settings.acceleration.split = *options.split;
    return read_request({source.name, api::write_job(request), source.folder});
}

double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

[[noreturn]] void interrupted()
{
    throw UserError(ExitCode::interrupted, "interrupted; nothing was written");
}

std::shared_ptr<const renderer::Scene> prepare_scene(LocalJob& job,
                                                     const renderer::Plan& plan,
                                                     renderer::ThreadPool& pool,
                                                     const std::stop_token& stop)
{
    const renderer::RenderSettings& settings = job.request.settings;
    std::vector<std::shared_ptr<const renderer::PreparedMesh>> prepared;
    for (std::size_t i = 0; i < job.meshes.size(); ++i) {
        prepared.push_back(renderer::prepare_mesh(std::move(job.meshes[i]), plan.mesh_trees[i], pool, stop));
        if (!prepared.back()) interrupted();
    }
    return renderer::prepare(job.assumed, plan, prepared, settings, pool, stop, job.images);
}

renderer::RenderResult
render_job(LocalJob& job, const renderer::Plan& plan, bool quiet, const std::stop_token& stop)
{
    const auto start = std::chrono::steady_clock::now();
    const renderer::RenderSettings& settings = job.request.settings;
    renderer::ThreadPool pool(settings.acceleration.threads);
    const auto scene = prepare_scene(job, plan, pool, stop);
    if (stop.stop_requested()) interrupted();
    const double prepare_s = seconds_since(start);

    ProgressBar bar(!quiet);
    auto result = renderer::render(
        *scene, plan, settings, pool, stop, [&bar](const renderer::RenderProgress& progress) {
            bar.show(progress.fraction, std::to_string(progress.samples) + " samples");
        });
    if (!result) interrupted();
    result->report.timing.prepare_s = prepare_s;
    return *std::move(result);
}

renderer::Picture picture_of(renderer::Film film, const api::JobRequest& request, double exposure_ev)
{
    const std::uint32_t samples = film.samples;
    renderer::FinishedFilm finished = finish(std::move(film));
    renderer::Picture picture{.image = std::move(finished.image),
                              .layers = std::move(finished.layers),
                              .exposure_ev = exposure_ev,
                              .tone = request.settings.image.tone,
                              .texts = {}};
    for (auto& [keyword, text] : api::provenance_of(request, render_key_of(request), samples))
        picture.texts.push_back({keyword, text});
    return picture;
}

void write_bytes(const std::string& path, const std::vector<std::uint8_t>& bytes)
{
    write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

// Before the render: after it, the picture would be lost.
void check_size(const std::string& output, renderer::PictureFormat format, const api::JobRequest& request)
{
    const renderer::ImageSettings& image = request.settings.image;
    const auto region = image.region.value_or(renderer::PixelRect{0, 0, image.width_px, image.height_px});
    const std::uint32_t most = entry_of(format).most_side_px;
    if (std::max(region.width, region.height) > most)
        throw UserError(ExitCode::usage,
                        output + ": the format holds at most " + std::to_string(most) + " pixels a side");
}

} // namespace

ExitCode render_command(const RenderOptions& options, const std::stop_token& stop)
{
    const renderer::PictureEncoding encoding = encoding_of(options.output, options.bits);
    check_writable(options.output);
    if (!options.report.empty()) check_writable(options.report);
    const std::vector<LayerFile> layers = read_layer_files(options.layers, options.bits);
    for (const LayerFile& file : layers)
        check_writable(file.path);
    const JobSource source = read_job_source(options.scene);
    LocalJob job =
        load_local_job(source, with_options(read_request(source), options, layers_of(layers), source));
    check_size(options.output, encoding.format, job.request);
    if (!options.quiet)
        for (const std::string& note : job.notes)
            std::fprintf(stderr, "note: %s\n", note.c_str());

    const renderer::Plan plan = plan_of(job);
    renderer::RenderResult result = render_job(job, plan, options.quiet, stop);
    result.report.notes = job.notes;
    const renderer::Picture picture = picture_of(std::move(result.film), job.request, plan.exposure_ev);
    write_bytes(options.output, renderer::encode_picture(picture, encoding));
    for (const LayerFile& file : layers)
        for (const renderer::LayerImage& layer : picture.layers)
            if (layer.layer == file.layer)
                write_bytes(file.path, renderer::encode_layer(picture, layer, file.encoding));
    if (!options.report.empty())
        write_file(options.report,
                   api::write_report(
                       result.report, "local", render_key_of(job.request), job.request.settings.quality));
    return ExitCode::ok;
}

} // namespace clients
