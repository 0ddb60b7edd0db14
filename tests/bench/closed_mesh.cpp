#include "tests/bench/closed_mesh.h"

#include "renderer/geometry/rounding.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace bench {

using namespace renderer;
using random_scenes::Random;

namespace {

constexpr double kLeastFacing = 0.02; // |cosine| between a ray and the normals where it crosses

std::uint32_t middle_of(Model& model,
                        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>& made,
                        std::uint32_t a,
                        std::uint32_t b,
                        double radius)
{
    const auto [entry, is_new] =
        made.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(model.places.size()));
    if (is_new) model.places.push_back(normalize(model.places[a] + model.places[b]) * radius);
    return entry->second;
}

} // namespace

Model icosphere(unsigned subdivisions, double radius)
{
    Model model{"icosphere", {}, {}};
    const double phi = (1 + std::sqrt(5.0)) / 2;
    for (const double a : {1.0, -1.0})
        for (const double b : {phi, -phi}) {
            model.places.push_back(normalize(Vec3d{0, a, b}) * radius);
            model.places.push_back(normalize(Vec3d{a, b, 0}) * radius);
            model.places.push_back(normalize(Vec3d{b, 0, a}) * radius);
        }
    // The hull: every three corners at the least distance from one another.
    const double edge = 2 * radius / std::sqrt(1 + phi * phi) * 1.001;
    for (std::uint32_t i = 0; i < 12; ++i)
        for (std::uint32_t j = i + 1; j < 12; ++j)
            for (std::uint32_t k = j + 1; k < 12; ++k) {
                const Vec3d a = model.places[i], b = model.places[j], c = model.places[k];
                if (length(a - b) > edge || length(b - c) > edge || length(c - a) > edge) continue;
                if (dot(cross(b - a, c - a), a) > 0)
                    model.triangles.push_back({i, j, k});
                else
                    model.triangles.push_back({i, k, j});
            }
    for (unsigned s = 0; s < subdivisions; ++s) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> made;
        std::vector<Triangle> finer;
        for (const auto& [a, b, c] : model.triangles) {
            const std::uint32_t ab = middle_of(model, made, a, b, radius),
                                bc = middle_of(model, made, b, c, radius),
                                ca = middle_of(model, made, c, a, radius);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        model.triangles = std::move(finer);
    }
    return model;
}

// A (2, 3) torus knot, a round tube along it.
Model torus_knot(unsigned rings, unsigned sides)
{
    Model model{"knot", {}, {}};
    const auto along = [&](double turn) {
        const double r = 2 + std::cos(3 * turn);
        return Vec3d{r * std::cos(2 * turn), std::sin(3 * turn), r * std::sin(2 * turn)};
    };
    for (unsigned i = 0; i < rings; ++i) {
        const double turn = 2 * kPi * i / rings;
        const Vec3d center = along(turn), forward = normalize(along(turn + 1e-4) - along(turn - 1e-4));
        const Vec3d side = normalize(cross(forward, Vec3d{0, 1, 0.1})), up = cross(side, forward);
        for (unsigned j = 0; j < sides; ++j) {
            const double round = 2 * kPi * j / sides;
            model.places.push_back(center + (side * std::cos(round) + up * std::sin(round)) * 0.4);
            const std::uint32_t a = i * sides + j, b = i * sides + (j + 1) % sides;
            const std::uint32_t c = (i + 1) % rings * sides + j,
                                d = (i + 1) % rings * sides + (j + 1) % sides;
            model.triangles.push_back({a, b, d});
            model.triangles.push_back({a, d, c});
        }
    }
    return model;
}

Model wrinkled_sphere(std::uint64_t seed, double low, double high, unsigned rings, unsigned segments)
{
    Random random(seed);
    const Mesh mesh = random_scenes::closed_sphere(random, {0, 0, 0}, low, high, rings, segments);
    Model model{low == high ? "sphere" : "random sphere", {}, {mesh.triangles.begin(), mesh.triangles.end()}};
    for (const Vec3f& p : mesh.positions)
        model.places.push_back(to_double(p));
    return model;
}

Model model_of(const Mesh& mesh, std::string name)
{
    Model model{std::move(name), {}, {}};
    const Bounds3d box = mesh.bounds_in_file();
    const double scale = 4 / max_component(box.extent());
    std::map<std::tuple<double, double, double>, std::uint32_t> made;
    std::vector<std::uint32_t> to;
    for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3d p = mesh.position(i);
        const auto [entry, is_new] =
            made.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(model.places.size()));
        if (is_new) model.places.push_back((p + mesh.origin - box.center()) * scale);
        to.push_back(entry->second);
    }
    for (const auto& [a, b, c] : mesh.triangles)
        model.triangles.push_back({to[a], to[b], to[c]});
    return model;
}

ClosedMesh::ClosedMesh(const Mesh& mesh, double slack)
    : mesh_(mesh), slack_(slack), size_(max_component(to_double(mesh.bounds().extent()))),
      around_corner_(mesh.positions.size()), across_(mesh.triangles.size(), {kOpen, kOpen, kOpen})
{
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::pair<std::uint32_t, std::uint32_t>>>
        edges;
    std::vector<bool> open(mesh.positions.size(), false);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle& v = mesh.triangles[t];
        const Vec3d a = mesh.position(v[0]), b = mesh.position(v[1]), c = mesh.position(v[2]);
        const Vec3d normal = cross(b - a, c - a);
        const bool flat = !(length(normal) > 0);
        normals_.push_back(flat ? Vec3d{} : normalize(normal));
        edges_.push_back(std::min({length(b - a), length(c - b), length(a - c)}));
        for (std::uint32_t k = 0; k < 3; ++k) {
            around_corner_[v[k]].push_back(t);
            edges[std::minmax(v[k], v[(k + 1) % 3])].emplace_back(t, k);
            if (flat) open[v[k]] = true;
        }
    }
    for (const auto& [ends, sides] : edges) {
        if (sides.size() == 2) {
            across_[sides[0].first][sides[0].second] = sides[1].first;
            across_[sides[1].first][sides[1].second] = sides[0].first;
        } else {
            open[ends.first] = open[ends.second] = true;
        }
    }
    for (std::size_t i = 0; i < open.size(); ++i)
        if (open[i]) around_corner_[i].clear();
}

ClosedMesh::Target ClosedMesh::target_on(Random& random, std::uint32_t triangle) const
{
    const Triangle& v = mesh_.triangles[triangle];
    const std::uint32_t k = random.below(3);
    const Vec3d a = mesh_.position(v[k]), b = mesh_.position(v[(k + 1) % 3]);
    if (random.below(2) == 0) return {a, around_corner_[v[k]]};
    const double w = random.uniform();
    if (across_[triangle][k] == kOpen) return {a, {}};
    return {a * w + b * (1 - w), {triangle, across_[triangle][k]}};
}

std::optional<AimedRay> ClosedMesh::ray_at(const Target& target, Vec3d origin) const
{
    const Vec3d away = target.place + mesh_.origin - origin;
    const double distance = length(away);
    if (target.triangles.empty() || !(distance > 0)) return std::nullopt;
    double least = 1, most = -1, edge = size_;
    for (const std::uint32_t t : target.triangles) {
        const double facing = dot(normals_[t], away) / distance;
        least = std::min(least, facing);
        most = std::max(most, facing);
        edge = std::min(edge, edges_[t]);
    }
    if (!(least > kLeastFacing || most < -kLeastFacing)) return std::nullopt;
    AimedRay aimed;
    aimed.ray.origin = origin - mesh_.origin;
    aimed.ray.direction = target.place - aimed.ray.origin;
    aimed.ray.t_max = 1 + std::max(0.25 * edge, slack_) / distance;
    aimed.target = target.place;
    return aimed;
}

void ClosedMesh::aim(Random& random, bool beam, std::array<AimedRay, 16>& rays) const
{
    const auto some_triangle = [&] {
        return random.below(static_cast<std::uint32_t>(mesh_.triangles.size()));
    };
    std::size_t made = 0;
    while (made < rays.size()) {
        std::uint32_t triangle = some_triangle();
        const auto from = [&] {
            const double distance = size_ * std::pow(10, random.uniform(-1.5, 0.7));
            return mesh_.position(mesh_.triangles[triangle][0]) + random.direction() * distance +
                   mesh_.origin;
        };
        Vec3d origin = from();
        for (int attempt = 0; attempt < 64 && made < rays.size(); ++attempt) {
            if (!beam) {
                triangle = some_triangle();
                origin = from();
            }
            if (const auto ray = ray_at(target_on(random, triangle), origin)) rays[made++] = *ray;
        }
        if (beam && made < rays.size()) made = 0; // all of a beam, or none
    }
}

} // namespace bench
