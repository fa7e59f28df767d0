// SPDX-License-Identifier: MIT
#include "quarters.h"

#include <algorithm>

namespace rlvc {
namespace {

struct Span {
    int from, to;
};

Span half(int side, bool second) {
    const int middle = side / 2;
    return second ? Span{middle, side} : Span{0, std::max(middle, 1)};
}

// Sums are exact, so that no order of adding matters.
void means(const Picture &picture, Span rows, Span columns, float *rgb) {
    uint64_t sum[3] = {0, 0, 0};
    for (int y = rows.from; y < rows.to; y++) {
        const uint8_t *pixel = picture.row(y) + columns.from * picture.channels;
        for (int x = columns.from; x < columns.to; x++, pixel += picture.channels)
            for (int c = 0; c < picture.channels; c++)
                sum[c] += pixel[c];
    }
    const double pixels = static_cast<double>(rows.to - rows.from) * (columns.to - columns.from);
    for (int c = 0; c < 3; c++) {
        const int from = picture.channels == 1 ? 0 : picture.blue_first ? 2 - c : c;
        rgb[c] = static_cast<float>(static_cast<double>(sum[from]) / pixels);
    }
}

} // namespace

void quarters(const Picture &picture, float *v) {
    for (int q = 0; q < 4; q++)
        means(picture, half(picture.height, q / 2 != 0), half(picture.width, q % 2 != 0),
              v + 3 * q);
}

} // namespace rlvc
