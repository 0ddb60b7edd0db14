// Rgb: linear Rec. 709 radiance or reflectance, one float a channel.
#pragma once

namespace renderer {

struct Rgb {
    float r{}, g{}, b{};

    friend constexpr Rgb operator+(Rgb a, Rgb b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
    friend constexpr Rgb operator*(Rgb a, Rgb b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
    friend constexpr Rgb operator*(Rgb a, float s) { return {a.r * s, a.g * s, a.b * s}; }
    friend constexpr Rgb operator*(float s, Rgb a) { return a * s; }
    friend constexpr Rgb operator/(Rgb a, float s) { return {a.r / s, a.g / s, a.b / s}; }
    constexpr Rgb& operator+=(Rgb o) { return *this = *this + o; }
    friend constexpr bool operator==(Rgb, Rgb) = default;
};

constexpr bool is_black(Rgb c)
{
    return c.r == 0 && c.g == 0 && c.b == 0;
}

} // namespace renderer
