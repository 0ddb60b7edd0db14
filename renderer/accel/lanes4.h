// Lanes4: four numbers at once: floats in SSE registers on x86-64, plain code that compilers vectorise elsewhere
// and for double.
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

template <typename T>
struct Lanes4 {
    T v[4];

    static Lanes4 load(const T* aligned) { return {{aligned[0], aligned[1], aligned[2], aligned[3]}}; }
    // x, y, z and 0.
    static Lanes4 load3(const Vec3<T>& p) { return {{p.x, p.y, p.z, 0}}; }
    static Lanes4 splat(T x) { return {{x, x, x, x}}; }
    void store(T* aligned) const
    {
        for (std::size_t i = 0; i < 4; ++i)
            aligned[i] = v[i];
    }
    // Towards zero; of values that fit.
    void store_truncated(std::int32_t* aligned) const
    {
        for (std::size_t i = 0; i < 4; ++i)
            aligned[i] = static_cast<std::int32_t>(v[i]);
    }
    static Lanes4 from_integers(const std::int32_t* aligned)
    {
        return {{static_cast<T>(aligned[0]),
                 static_cast<T>(aligned[1]),
                 static_cast<T>(aligned[2]),
                 static_cast<T>(aligned[3])}};
    }

    template <typename Op>
    static Lanes4 each(Lanes4 a, Lanes4 b, Op op)
    {
        return {{op(a.v[0], b.v[0]), op(a.v[1], b.v[1]), op(a.v[2], b.v[2]), op(a.v[3], b.v[3])}};
    }
    friend Lanes4 operator+(Lanes4 a, Lanes4 b)
    {
        return each(a, b, [](T x, T y) { return x + y; });
    }
    friend Lanes4 operator-(Lanes4 a, Lanes4 b)
    {
        return each(a, b, [](T x, T y) { return x - y; });
    }
    friend Lanes4 operator*(Lanes4 a, Lanes4 b)
    {
        return each(a, b, [](T x, T y) { return x * y; });
    }
    friend Lanes4 min(Lanes4 a, Lanes4 b)
    {
        return each(a, b, [](T x, T y) { return x < y ? x : y; });
    }
    friend Lanes4 max(Lanes4 a, Lanes4 b)
    {
        return each(a, b, [](T x, T y) { return x > y ? x : y; });
    }
    // Bit i is set where a[i] < b[i]; never with a NaN.
    friend unsigned less(Lanes4 a, Lanes4 b)
    {
        unsigned bits = 0;
        for (unsigned i = 0; i < 4; ++i)
            bits |= a.v[i] < b.v[i] ? 1u << i : 0u;
        return bits;
    }
    // Rows to columns.
    friend void transpose(Lanes4& a, Lanes4& b, Lanes4& c, Lanes4& d)
    {
        const Lanes4 rows[4]{a, b, c, d};
        for (std::size_t i = 0; i < 4; ++i) {
            a.v[i] = rows[i].v[0];
            b.v[i] = rows[i].v[1];
            c.v[i] = rows[i].v[2];
            d.v[i] = rows[i].v[3];
        }
    }
};

#if defined(__SSE2__)

template <>
struct Lanes4<float> {
    __m128 v;

    static Lanes4 load(const float* aligned) { return {_mm_load_ps(aligned)}; }
    // What lies behind the three is read too: 16 readable bytes, aligned.
    static Lanes4 load3(const Vec3f& padded)
    {
        return {_mm_and_ps(_mm_load_ps(&padded.x), _mm_castsi128_ps(_mm_set_epi32(0, -1, -1, -1)))};
    }
    static Lanes4 splat(float x) { return {_mm_set1_ps(x)}; }
    void store(float* aligned) const { _mm_store_ps(aligned, v); }
    void store_truncated(std::int32_t* aligned) const
    {
        _mm_store_si128(reinterpret_cast<__m128i*>(aligned), _mm_cvttps_epi32(v));
    }
    static Lanes4 from_integers(const std::int32_t* aligned)
    {
        return {_mm_cvtepi32_ps(_mm_load_si128(reinterpret_cast<const __m128i*>(aligned)))};
    }

    friend Lanes4 operator+(Lanes4 a, Lanes4 b) { return {_mm_add_ps(a.v, b.v)}; }
    friend Lanes4 operator-(Lanes4 a, Lanes4 b) { return {_mm_sub_ps(a.v, b.v)}; }
    friend Lanes4 operator*(Lanes4 a, Lanes4 b) { return {_mm_mul_ps(a.v, b.v)}; }
    friend Lanes4 min(Lanes4 a, Lanes4 b) { return {_mm_min_ps(a.v, b.v)}; }
    friend Lanes4 max(Lanes4 a, Lanes4 b) { return {_mm_max_ps(a.v, b.v)}; }
    friend unsigned less(Lanes4 a, Lanes4 b)
    {
        return static_cast<unsigned>(_mm_movemask_ps(_mm_cmplt_ps(a.v, b.v)));
    }
    friend void transpose(Lanes4& a, Lanes4& b, Lanes4& c, Lanes4& d)
    {
        _MM_TRANSPOSE4_PS(a.v, b.v, c.v, d.v);
    }
};

#endif

} // namespace renderer
