#include "renderer/io/triangulate.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

namespace renderer {

namespace {

using Point = std::array<double, 2>;

Vec3d newell_normal(std::span<const Vec3d> corners)
{
    const Vec3d origin = corners[0]; // sums of products of differences: far from the origin they would cancel
    Vec3d sum{};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3d a = corners[i] - origin, b = corners[(i + 1) % corners.size()] - origin;
        sum = sum + cross(a, b);
    }
    return sum;
}

// Twice the signed area of abc.
double turn(const Point& a, const Point& b, const Point& c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

std::vector<Point> project(std::span<const Vec3d> corners, Vec3d normal)
{
    const Vec3d size = abs(normal);
    const std::size_t drop = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const bool flip = normal[drop] < 0;
    std::vector<Point> points(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3d p = corners[i];
        points[i] = {p[(drop + 1) % 3], p[(drop + 2) % 3]};
        if (flip) std::swap(points[i][0], points[i][1]);
    }
    return points;
}

bool is_convex(const std::vector<Point>& p)
{
    const std::size_t n = p.size();
    // No left turn missing, and the outline goes round once: the direction in x changes its sign twice only.
    int changes = 0;
    double last = 0, first = 0;
    for (std::size_t i = 0; i < n; ++i) {
        if (turn(p[i], p[(i + 1) % n], p[(i + 2) % n]) < 0) return false;
        const double dx = p[(i + 1) % n][0] - p[i][0];
        if (dx == 0) continue;
        if (last != 0 && (dx > 0) != (last > 0)) ++changes;
        if (first == 0) first = dx;
        last = dx;
    }
    if (last != 0 && (first > 0) != (last > 0)) ++changes;
    return changes <= 2;
}

void fan(std::span<const std::uint32_t> ring, std::vector<Triangle>& out)
{
    for (std::size_t i = 2; i < ring.size(); ++i)
        out.push_back({ring[0], ring[i - 1], ring[i]});
}

bool inside(const Point& p, const Point& a, const Point& b, const Point& c)
{
    if (p == a || p == b || p == c) return false;
    return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

bool is_ear(const std::vector<Point>& p, const std::vector<std::uint32_t>& ring, std::size_t at)
{
    const std::size_t n = ring.size();
    const Point &a = p[ring[(at + n - 1) % n]], &b = p[ring[at]], &c = p[ring[(at + 1) % n]];
    if (turn(a, b, c) <= 0) return false;
    return std::none_of(
        ring.begin(), ring.end(), [&](std::uint32_t other) { return inside(p[other], a, b, c); });
}

void clip_ears(const std::vector<Point>& p, std::vector<std::uint32_t>& ring, std::vector<Triangle>& out)
{
    while (ring.size() > 3) {
        const std::size_t n = ring.size();
        std::size_t ear = 0;
        while (ear < n && !is_ear(p, ring, ear))
            ++ear;
        if (ear == n) break; // degenerate or self-crossing: what is left becomes a fan
        out.push_back({ring[(ear + n - 1) % n], ring[ear], ring[(ear + 1) % n]});
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    fan(ring, out);
}

// The diagonal that leaves both halves wound like the whole.
void split_quad(std::span<const Vec3d> corners, std::vector<Triangle>& out)
{
    const Vec3d normal = newell_normal(corners);
    const auto side = [&](std::size_t a, std::size_t b, std::size_t c) {
        const Vec3d from = corners[a];
        return dot(cross(corners[b] - from, corners[c] - from), normal);
    };
    if (side(0, 1, 2) >= 0 && side(0, 2, 3) >= 0) {
        out.push_back({0, 1, 2});
        out.push_back({0, 2, 3});
    } else {
        out.push_back({1, 2, 3});
        out.push_back({1, 3, 0});
    }
}

} // namespace

bool triangulate(std::span<const Vec3d> corners, std::vector<Triangle>& out)
{
    if (corners.size() == 3) {
        out.push_back({0, 1, 2});
        return true;
    }
    if (corners.size() == 4) {
        split_quad(corners, out);
        return true;
    }
    std::vector<std::uint32_t> ring(corners.size());
    std::iota(ring.begin(), ring.end(), 0u);
    const std::vector<Point> points = project(corners, newell_normal(corners));
    if (is_convex(points)) {
        fan(ring, out);
        return true;
    }
    if (corners.size() > kMostConcaveCorners) return false;
    clip_ears(points, ring, out);
    return true;
}

Vec3f polygon_normal(std::span<const Vec3d> corners)
{
    const Vec3d normal = newell_normal(corners);
    if (!(max_component(abs(normal)) > 0) || !is_finite(normal)) return {0, 0, 1};
    return to_float(normalize(normal));
}

} // namespace renderer
