// SPDX-License-Identifier: MIT
// The passes of rows.h, included by each file that compiles them for a kind of machine: RLVC_ROWS
// names the table that results, RLVC_ROWS_LANES is the floats of a register. Nothing here may call
// an inline function of a header: the linker keeps one copy of such, which might be the one that
// the machine at hand does not run.
#include "rows.h"

#if !defined(RLVC_ROWS) || !defined(RLVC_ROWS_LANES)
#error "included by rows_*.cc only"
#endif

namespace rlvc {
namespace {

constexpr size_t lanes = RLVC_ROWS_LANES;
static_assert(row_block % lanes == 0, "a block is whole registers");

typedef float Vector __attribute__((vector_size(lanes * sizeof(float))));
typedef float Unaligned
    __attribute__((vector_size(lanes * sizeof(float)), aligned(sizeof(float)), may_alias));

typedef int32_t Mask __attribute__((vector_size(lanes * sizeof(float))));
typedef int64_t Pairs __attribute__((vector_size(lanes * sizeof(float)), may_alias));

inline Vector load(const float *from) {
    return *reinterpret_cast<const Unaligned *>(from);
}

inline void store(float *to, Vector v) {
    *reinterpret_cast<Unaligned *>(to) = v;
}

void widen(const uint8_t *bytes, size_t n, float *out) {
    for (size_t x = 0; x < n; x += row_block)
        for (size_t i = 0; i < row_block; i++)
            out[x + i] = static_cast<float>(bytes[x + i]);
}

void down(const float *const *rows, const Taps &taps, size_t n, float *smoothed, float *derived) {
    const int r = taps.radius;
    for (size_t x = 0; x < n; x += lanes) {
        Vector s = load(rows[r] + x) * taps.smooth[0];
        Vector d{};
        for (int j = 1; j <= r; j++) {
            const Vector above = load(rows[r - j] + x);
            const Vector below = load(rows[r + j] + x);
            s += (above + below) * taps.smooth[j];
            d += (below - above) * taps.derive[j];
        }
        store(smoothed + x, s);
        store(derived + x, d);
    }
}

void tensor(const float *const *smoothed, const float *const *derived, const float *weight,
            int channels, const Taps &taps, size_t n, float *xx, float *xy, float *yy) {
    const int r = taps.radius;
    for (size_t x = 0; x < n; x += lanes) {
        Vector sum_xx{}, sum_xy{}, sum_yy{};
        for (int c = 0; c < channels; c++) {
            const float *s = smoothed[c] + r + x;
            const float *d = derived[c] + r + x;
            Vector ix{};
            Vector iy = load(d) * taps.smooth[0];
            for (int j = 1; j <= r; j++) {
                ix += (load(s + j) - load(s - j)) * taps.derive[j];
                iy += (load(d - j) + load(d + j)) * taps.smooth[j];
            }
            const Vector wx = ix * weight[c];
            sum_xx += wx * ix;
            sum_xy += wx * iy;
            sum_yy += iy * weight[c] * iy;
        }
        store(xx + x, sum_xx);
        store(xy + x, sum_xy);
        store(yy + x, sum_yy);
    }
}

void blur(const float *const *rows, const Taps &taps, size_t n, float *out) {
    const int r = taps.radius;
    for (size_t x = 0; x < n; x += lanes) {
        Vector s = load(rows[r] + x) * taps.smooth[0];
        for (int j = 1; j <= r; j++)
            s += (load(rows[r - j] + x) + load(rows[r + j] + x)) * taps.smooth[j];
        store(out + x, s);
    }
}

inline Vector blur_along(const float *row, const Taps &taps) {
    const float *middle = row + taps.radius;
    Vector s = load(middle) * taps.smooth[0];
    for (int j = 1; j <= taps.radius; j++)
        s += (load(middle - j) + load(middle + j)) * taps.smooth[j];
    return s;
}

void response(const float *xx, const float *xy, const float *yy, const Taps &taps, float k,
              size_t n, float *h) {
    for (size_t x = 0; x < n; x += lanes) {
        const Vector a = blur_along(xx + x, taps);
        const Vector b = blur_along(xy + x, taps);
        const Vector c = blur_along(yy + x, taps);
        const Vector trace = a + c;
        store(h + x, (a * c - b * b) - trace * trace * k);
    }
}

size_t peaks(const float *up, const float *middle, const float *low, float above, size_t n,
             uint32_t *at) {
    const Vector limit = above - Vector{};
    size_t count = 0;
    for (size_t x = 0; x < n; x += lanes) {
        const Vector h = load(middle + x);
        const Mask is = (h > limit) & (h >= load(middle + x - 1)) & (h >= load(middle + x + 1)) &
                        (h >= load(up + x - 1)) & (h >= load(up + x)) & (h >= load(up + x + 1)) &
                        (h >= load(low + x - 1)) & (h >= load(low + x)) & (h >= load(low + x + 1));
        int64_t any = 0;
        for (size_t i = 0; i < lanes / 2; i++)
            any |= reinterpret_cast<const Pairs &>(is)[i];
        if (any == 0)
            continue;
        for (size_t i = 0; i < lanes; i++)
            if (is[i] != 0)
                at[count++] = static_cast<uint32_t>(x + i);
    }
    return count;
}

} // namespace

extern const RowPasses RLVC_ROWS;
const RowPasses RLVC_ROWS = {widen, down, tensor, blur, response, peaks};

} // namespace rlvc
