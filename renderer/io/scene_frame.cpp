#include "renderer/io/scene_frame.h"

#include <assimp/scene.h>

#include <cmath>
#include <cstdint>
#include <optional>

namespace renderer {

namespace {

std::optional<double> number_of(const aiMetadata& said, const char* key)
{
    double wide = 0;
    float narrow = 0;
    std::int32_t whole = 0;
    if (said.Get(key, wide)) return wide;
    if (said.Get(key, narrow)) return narrow;
    if (said.Get(key, whole)) return whole;
    return std::nullopt;
}

// Turns the axis that is up in the file (0 to 2, and its side) to +y.
Affine3 y_up_from(int axis, double side)
{
    Affine3 turn;
    const Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    if (axis == 0)
        turn.rows = {y * -side, x * side, z};
    else if (axis == 1)
        turn.rows = {x, y * side, z * side};
    else
        turn.rows = {x, z * side, y * -side};
    return turn;
}

} // namespace

Affine3 world_from_file(const aiScene& scene)
{
    if (!scene.mMetaData) return {};
    const auto unit_cm = number_of(*scene.mMetaData, "UnitScaleFactor");
    if (!unit_cm) return {};
    const auto up = number_of(*scene.mMetaData, "UpAxis"), sign = number_of(*scene.mMetaData, "UpAxisSign");
    const double metres = std::isfinite(*unit_cm) && *unit_cm > 0 ? *unit_cm / 100 : 0.01;
    const int axis = up && (*up == 0 || *up == 1 || *up == 2) ? static_cast<int>(*up) : 1;
    return Affine3::scale({metres, metres, metres}) * y_up_from(axis, sign && *sign < 0 ? -1 : 1);
}

} // namespace renderer
