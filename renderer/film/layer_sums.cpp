#include "renderer/film/layer_sums.h"

#include <cmath>
#include <limits>

namespace renderer {

namespace {

void append_mean(std::vector<float>& values, const RgbSum& sum, double samples)
{
    for (const double channel : {sum.r, sum.g, sum.b})
        values.push_back(samples > 0 ? static_cast<float>(channel / samples) : 0.0f);
}

LayerImage mean_of(Layer layer, const std::vector<RgbSum>& sums, std::uint32_t samples)
{
    LayerImage image{layer, {}};
    image.values.reserve(sums.size() * 3);
    for (const RgbSum& sum : sums)
        append_mean(image.values, sum, samples);
    return image;
}

LayerImage mean_depth(const std::vector<DepthSum>& sums)
{
    LayerImage image{Layer::depth, {}};
    image.values.reserve(sums.size());
    for (const DepthSum& sum : sums)
        image.values.push_back(sum.hits > 0 ? static_cast<float>(sum.metres / static_cast<double>(sum.hits))
                                            : std::numeric_limits<float>::infinity());
    return image;
}

} // namespace

LayerSums::LayerSums(LayerSet asked, std::size_t pixels)
    : asked_(asked), pixels_(pixels), depth_(asked.has(Layer::depth) ? pixels : 0),
      normal_(asked.has(Layer::normal) ? pixels : 0), albedo_(asked.has(Layer::albedo) ? pixels : 0)
{
}

void LayerSums::add(std::size_t pixel, double distance_m, Vec3f normal, Rgb albedo)
{
    if (!depth_.empty() && std::isfinite(distance_m)) {
        depth_[pixel].metres += distance_m;
        ++depth_[pixel].hits;
    }
    if (!normal_.empty() && std::isfinite(normal.x + normal.y + normal.z))
        normal_[pixel] += Rgb{normal.x, normal.y, normal.z};
    if (!albedo_.empty() && std::isfinite(albedo.r + albedo.g + albedo.b)) albedo_[pixel] += albedo;
}

void LayerSums::add(const LayerSums& part, std::size_t from, std::size_t to, std::size_t count)
{
    if (asked_.empty()) return;
    for (std::size_t i = 0; i < count; ++i) {
        if (!depth_.empty()) {
            depth_[to + i].metres += part.depth_[from + i].metres;
            depth_[to + i].hits += part.depth_[from + i].hits;
        }
        if (!normal_.empty()) normal_[to + i] += part.normal_[from + i];
        if (!albedo_.empty()) albedo_[to + i] += part.albedo_[from + i];
    }
}

std::vector<LayerImage> LayerSums::mean(std::uint32_t samples) const
{
    std::vector<LayerImage> images;
    if (asked_.has(Layer::depth)) images.push_back(mean_depth(depth_));
    if (asked_.has(Layer::normal)) images.push_back(mean_of(Layer::normal, normal_, samples));
    if (asked_.has(Layer::albedo)) images.push_back(mean_of(Layer::albedo, albedo_, samples));
    if (asked_.has(Layer::samples))
        images.push_back({Layer::samples, std::vector<float>(pixels_, static_cast<float>(samples))});
    return images;
}

std::size_t layer_sum_bytes(LayerSet asked)
{
    return (asked.has(Layer::depth) ? sizeof(DepthSum) : 0) +
           (asked.has(Layer::normal) ? sizeof(RgbSum) : 0) + (asked.has(Layer::albedo) ? sizeof(RgbSum) : 0);
}

std::size_t layer_image_bytes(LayerSet asked)
{
    std::size_t bytes = 0;
    for (const LayerEntry& entry : kLayers)
        if (asked.has(entry.layer)) bytes += entry.channel_count() * sizeof(float);
    return bytes;
}

} // namespace renderer
