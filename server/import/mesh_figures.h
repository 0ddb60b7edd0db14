// mesh_figures: what GET /v1/assets/{digest}/info tells of an imported mesh.
#pragma once

#include "api/job_view.h"
#include "server/import/flat_mesh.h"
#include "server/import/import_cache.h"

#include <cstdint>
#include <string>

namespace server {

// O(triangles).
api::AssetInfo::MeshInfo mesh_figures(const ImportedAsset& asset);

// The same of a picture.
api::AssetInfo::ImageInfo picture_figures(const ImportedPicture& picture);

// All that is told of an asset of so many bytes.
api::AssetInfo info_of(const std::string& digest, std::uint64_t bytes, const KnownImport& known);

} // namespace server
