#include "clients/cli/layer_files.h"

#include "clients/cli/files.h"
#include "clients/cli/user_error.h"

namespace clients {
namespace {

std::string extensions_of(renderer::Layer layer)
{
    std::string extensions;
    for (const renderer::PictureFormatEntry& entry : renderer::kPictureFormats)
        if (holds(entry.format, layer))
            extensions.append(extensions.empty() ? "" : " ").append(entry.extension);
    return extensions;
}

LayerFile read_layer_file(const std::string& word, std::optional<std::uint32_t> bits)
{
    const std::size_t equals = word.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == word.size())
        throw UserError(ExitCode::usage,
                        "--layer " + word + ": write NAME=FILE, NAME being one of " +
                            names_of(renderer::kEveryLayer));
    const std::string name = word.substr(0, equals), path = word.substr(equals + 1);
    const renderer::LayerEntry* const entry = renderer::find_layer(name);
    if (entry == nullptr)
        throw UserError(ExitCode::usage,
                        "--layer " + word + ": there is no layer " + name + ", but " +
                            names_of(renderer::kEveryLayer));
    const renderer::PictureFormatEntry* const format =
        renderer::find_picture_extension(lower_extension(path));
    if (format == nullptr || !holds(format->format, entry->layer))
        throw UserError(ExitCode::usage,
                        path + ": the name's end tells the format, of " + name + " " +
                            extensions_of(entry->layer));
    const bool is_png = format->format == renderer::PictureFormat::png;
    return {entry->layer, path, {format->format, static_cast<std::uint8_t>(is_png ? bits.value_or(8) : 8)}};
}

} // namespace

std::vector<LayerFile> read_layer_files(const std::vector<std::string>& words,
                                        std::optional<std::uint32_t> bits)
{
    std::vector<LayerFile> files;
    files.reserve(words.size());
    for (const std::string& word : words)
        files.push_back(read_layer_file(word, bits));
    return files;
}

renderer::LayerSet layers_of(const std::vector<LayerFile>& files)
{
    renderer::LayerSet layers;
    for (const LayerFile& file : files)
        layers.add(file.layer);
    return layers;
}

} // namespace clients
