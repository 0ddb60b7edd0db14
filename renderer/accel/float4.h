// Float4: four floats at once, where the processor has them: SSE on x86-64, plain code that compilers
// vectorise elsewhere.
//
// Promise  every operation rounds as the scalar one does. min and max return their second operand where a NaN
//          is in play, everywhere alike.
#pragma once

#include "renderer/math/vec3.h"

#include <cstddef>
#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace renderer {

#if defined(__SSE2__)

struct Float4 {
    __m128 v;

    static Float4 load(const float* aligned) { return {_mm_load_ps(aligned)}; }
    // x, y, z and 0. What lies behind them is read too: 16 readable bytes, aligned.
    static Float4 load3(const Vec3f& padded)
    {
        return {_mm_and_ps(_mm_load_ps(&padded.x), _mm_castsi128_ps(_mm_set_epi32(0, -1, -1, -1)))};
    }
    static Float4 splat(float x) { return {_mm_set1_ps(x)}; }
    void store(float* aligned) const { _mm_store_ps(aligned, v); }

    friend Float4 operator+(Float4 a, Float4 b) { return {_mm_add_ps(a.v, b.v)}; }
    friend Float4 operator-(Float4 a, Float4 b) { return {_mm_sub_ps(a.v, b.v)}; }
    friend Float4 operator*(Float4 a, Float4 b) { return {_mm_mul_ps(a.v, b.v)}; }
    friend Float4 min(Float4 a, Float4 b) { return {_mm_min_ps(a.v, b.v)}; }
    friend Float4 max(Float4 a, Float4 b) { return {_mm_max_ps(a.v, b.v)}; }
    friend Float4 abs(Float4 a) { return {_mm_andnot_ps(_mm_set1_ps(-0.0f), a.v)}; }
    // Bit i is set where a[i] <= b[i], a[i] < b[i]; never with a NaN.
    friend unsigned less_equal(Float4 a, Float4 b)
    {
        return static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(a.v, b.v)));
    }
    friend unsigned less(Float4 a, Float4 b)
    {
        return static_cast<unsigned>(_mm_movemask_ps(_mm_cmplt_ps(a.v, b.v)));
    }
};

#else

struct Float4 {
    float v[4];

    static Float4 load(const float* p) { return {{p[0], p[1], p[2], p[3]}}; }
    static Float4 load3(const Vec3f& padded) { return {{padded.x, padded.y, padded.z, 0}}; }
    static Float4 splat(float x) { return {{x, x, x, x}}; }
    void store(float* p) const
    {
        for (std::size_t i = 0; i < 4; ++i)
            p[i] = v[i];
    }

    template <typename Op>
    static Float4 each(Float4 a, Float4 b, Op op)
    {
        return {{op(a.v[0], b.v[0]), op(a.v[1], b.v[1]), op(a.v[2], b.v[2]), op(a.v[3], b.v[3])}};
    }
    template <typename Op>
    static unsigned mask(Float4 a, Float4 b, Op op)
    {
        unsigned bits = 0;
        for (unsigned i = 0; i < 4; ++i)
            bits |= op(a.v[i], b.v[i]) ? 1u << i : 0u;
        return bits;
    }
    friend Float4 operator+(Float4 a, Float4 b)
    {
        return each(a, b, [](float x, float y) { return x + y; });
    }
    friend Float4 operator-(Float4 a, Float4 b)
    {
        return each(a, b, [](float x, float y) { return x - y; });
    }
    friend Float4 operator*(Float4 a, Float4 b)
    {
        return each(a, b, [](float x, float y) { return x * y; });
    }
    friend Float4 min(Float4 a, Float4 b)
    {
        return each(a, b, [](float x, float y) { return x < y ? x : y; });
    }
    friend Float4 max(Float4 a, Float4 b)
    {
        return each(a, b, [](float x, float y) { return x > y ? x : y; });
    }
    friend Float4 abs(Float4 a)
    {
        return each(a, a, [](float x, float) { return __builtin_fabsf(x); });
    }
    friend unsigned less_equal(Float4 a, Float4 b)
    {
        return mask(a, b, [](float x, float y) { return x <= y; });
    }
    friend unsigned less(Float4 a, Float4 b)
    {
        return mask(a, b, [](float x, float y) { return x < y; });
    }
};

#endif

} // namespace renderer
