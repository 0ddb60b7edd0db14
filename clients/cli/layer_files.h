// Layers that a command writes beside its picture: NAME=FILE, the file's extension tells the format.
//
// Errors  UserError(usage) for a name that is no layer, an extension that tells no format, and one that does not hold
//         this layer.
#pragma once

#include "renderer/description/layers.h"
#include "renderer/description/picture_formats.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace clients {

struct LayerFile {
    renderer::Layer layer = renderer::Layer::depth;
    std::string path;
    renderer::PictureEncoding encoding;
};

// `bits`: a channel, where the file is a PNG.
std::vector<LayerFile> read_layer_files(const std::vector<std::string>& words,
                                        std::optional<std::uint32_t> bits);

renderer::LayerSet layers_of(const std::vector<LayerFile>& files);

} // namespace clients
