// KeptPicture: a finished picture as one blob: the PNG that most ask for, as it is sent, and the linear film with
// what is needed to write it in every other format. One name, one file, one fsync.
//
// On disk  "HGPIC\2", the PNG, how it is shown, its texts, the film packed (renderer/film/pack_floats.h), the layers
//          beside it likewise; numbers little-endian, lengths in front. "HGPIC\1" has no layers, and a blob that is a
//          PNG alone nothing else: pictures of older builds.
// Threads  pure functions.
// Errors   a blob is proven before it comes here, so bytes that do not hold are StoreError.
#pragma once

#include "renderer/film/picture.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace server {

std::vector<std::byte> pack_picture(const renderer::Picture& picture, std::span<const std::uint8_t> png);

std::span<const std::byte> png_of(std::span<const std::byte> blob);

// Nothing: there is the PNG alone.
std::optional<renderer::Picture> unpack_picture(std::span<const std::byte> blob);

} // namespace server
