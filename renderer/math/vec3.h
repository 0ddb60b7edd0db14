// Vec3: three components, used for points, directions and normals alike; the name at the point of use says
// which.
//
// Precision  Vec3d carries world space, cameras and transforms; Vec3f carries mesh-local vertices and
//            kernels.
// Cost       plain values, no allocation, never throws.
#pragma once

#include <cmath>
#include <cstddef>

namespace renderer {

template <typename T>
struct Vec3 {
    T x{}, y{}, z{};

    constexpr T& operator[](std::size_t axis) { return axis == 0 ? x : axis == 1 ? y : z; }
    constexpr T operator[](std::size_t axis) const { return axis == 0 ? x : axis == 1 ? y : z; }

    friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
    friend constexpr Vec3 operator*(Vec3 a, T s) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr Vec3 operator*(T s, Vec3 a) { return a * s; }
    friend constexpr Vec3 operator/(Vec3 a, T s) { return {a.x / s, a.y / s, a.z / s}; }
    friend constexpr bool operator==(Vec3, Vec3) = default;
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

struct Vec2f {
    float x{}, y{};
    friend constexpr bool operator==(Vec2f, Vec2f) = default;
};

template <typename T>
constexpr T dot(Vec3<T> a, Vec3<T> b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename T>
constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <typename T>
constexpr T max_component(Vec3<T> v)
{
    const T xy = v.x > v.y ? v.x : v.y;
    return xy > v.z ? xy : v.z;
}

template <typename T>
Vec3<T> abs(Vec3<T> v)
{
    return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}

// Euclidean length; scaled first, so that neither 1e-300 nor 1e300 under- or overflows. 0 for the zero
// vector.
template <typename T>
T length(Vec3<T> v)
{
    const T largest = max_component(abs(v));
    if (!(largest > 0)) return largest;
    const Vec3<T> s = v / largest;
    return largest * std::sqrt(dot(s, s));
}

// Unit vector along v; v must not be zero and must be finite.
template <typename T>
Vec3<T> normalize(Vec3<T> v)
{
    const Vec3<T> s = v / max_component(abs(v));
    return s / std::sqrt(dot(s, s));
}

constexpr Vec3d to_double(Vec3f v)
{
    return {v.x, v.y, v.z};
}
constexpr Vec3f to_float(Vec3d v)
{
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

inline bool is_finite(Vec3d v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
inline bool is_finite(Vec3f v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

} // namespace renderer
