// mesh_figures: what GET /v1/assets/{digest}/info tells of an imported mesh.
#pragma once

#include "api/job_view.h"
#include "server/import/flat_mesh.h"

namespace server {

// O(triangles).
api::AssetInfo::MeshInfo mesh_figures(const ImportedAsset& asset);

// The same of a picture.
api::AssetInfo::ImageInfo picture_figures(const ImportedPicture& picture);

} // namespace server
