// Where an object stands: a list of steps applied in order, or one matrix.
#include "api/json/pointer.h"
#include "api/read/read_fields.h"
#include "api/words/sentences.h"

#include <cmath>

namespace api {

namespace {

constexpr Range kFactor{-1e18, 1e18};

bool in_reach(const renderer::Affine3& map)
{
    const auto reaches = [](renderer::Vec3d v) {
        return kCoordinate.contains(v.x) && kCoordinate.contains(v.y) && kCoordinate.contains(v.z);
    };
    return reaches(map.rows[0]) && reaches(map.rows[1]) && reaches(map.rows[2]) && reaches(map.translation);
}

} // namespace

void ReadFields::placement(renderer::Affine3& world_from_object)
{
    const std::size_t faults_before = state_.faults.count();
    exclude("transform", "matrix", "give the steps or the matrix");
    renderer::Affine3 read = world_from_object;
    matrix_of(read);
    transform_of(read);
    const char* name = node_ && node_->contains("transform") ? "transform" : "matrix";
    if (state_.faults.count() != faults_before) return;
    if (!in_reach(read))
        return fault(at(name), "out_of_range", "a number of the resulting matrix is not in [-1e+18, 1e+18]");
    if (!read.inverse())
        return fault(
            at(name), "singular", "it flattens the object to nothing: no direction may be scaled to zero");
    world_from_object = read;
}

void ReadFields::matrix_of(renderer::Affine3& world_from_object)
{
    const auto read = numbers<16>("matrix", kCoordinate);
    if (!read) return;
    const std::array<double, 16>& m = *read;
    for (std::size_t i = 12; i < 16; ++i)
        if (m[i] != (i == 15 ? 1 : 0))
            return fault(at("matrix", i), "not_affine", "the last of the four rows must be 0, 0, 0, 1");
    world_from_object.rows = {{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}};
    world_from_object.translation = {m[3], m[7], m[11]};
}

void ReadFields::transform_of(renderer::Affine3& world_from_object)
{
    const Json* steps = array_of("transform", nullptr);
    for (std::size_t i = 0; steps && i < steps->size(); ++i) {
        ReadFields step((*steps)[i], at("transform", i), state_);
        if (const std::optional<renderer::Affine3> map = step.transform_step())
            world_from_object = *map * world_from_object;
        step.finish();
    }
}

std::optional<renderer::Affine3> ReadFields::transform_step()
{
    if (!node_) return std::nullopt;
    double degrees = 0;
    renderer::Vec3d axis{}, offset{};
    const std::optional<renderer::Vec3d> factors = scale_factors();
    const bool has_turn = number("rotate_deg", degrees, kTurn, nullptr);
    const bool has_axis = direction("axis", axis, nullptr);
    const bool has_offset = point("translate", offset, nullptr);

    const bool turns = node_->contains("rotate_deg");
    const int kinds = node_->contains("scale") + turns + node_->contains("translate");
    if (kinds != 1) {
        fault(
            pointer_,
            kinds == 0 ? "missing_member" : "exclusive_members",
            R"(a step is one of {"scale": s}, {"rotate_deg": d, "axis": [x, y, z]}, {"translate": [x, y, z]})");
        return std::nullopt;
    }
    if (turns) needs({"axis"});
    if (!turns && node_->contains("axis"))
        fault(at("axis"), "unknown_member", "\"axis\" belongs to rotate_deg");
    if (factors) return renderer::Affine3::scale(*factors);
    if (has_turn && has_axis) return renderer::Affine3::rotate_deg(degrees, axis);
    if (has_offset) return renderer::Affine3::translate(offset);
    return std::nullopt;
}

// One factor for all axes, or one for each.
std::optional<renderer::Vec3d> ReadFields::scale_factors()
{
    renderer::Vec3d factors{};
    if (node_->contains("scale") && node_->at("scale").is_number()) {
        if (!number("scale", factors.x, kFactor, nullptr)) return std::nullopt;
        factors = {factors.x, factors.x, factors.x};
    } else if (!point("scale", factors, nullptr)) {
        return std::nullopt;
    }
    if (factors.x != 0 && factors.y != 0 && factors.z != 0) return factors;
    fault(at("scale"), "singular", "a factor of 0 flattens the object to nothing");
    return std::nullopt;
}

} // namespace api
