/* SPDX-License-Identifier: MIT */
/* CRC-32, half a byte at a time: 64 bytes of table do what a kilobyte would do less than twice as
 * fast. */
#include "rlvc/float_rules.h"

#include "crc.h"

#define POLYNOMIAL 0xedb88320u
#define X_0 0x80000000u /* x^0 */
#define X_8 0x00800000u

/* remainder_of[n] is n divided by the polynomial, both with the lowest bit first: four times, c is
 * shifted right and, if a 1 fell out, 0xedb88320 added. */
static const uint32_t remainder_of[16] = {
    0x00000000u, 0x1db71064u, 0x3b6e20c8u, 0x26d930acu, 0x76dc4190u, 0x6b6b51f4u,
    0x4db26158u, 0x5005713cu, 0xedb88320u, 0xf00f9344u, 0xd6d6a3e8u, 0xcb61b38cu,
    0x9b64c2b0u, 0x86d3d2d4u, 0xa00ae278u, 0xbdbdf21cu,
};

uint32_t rlvc_crc(uint32_t crc, const void *data, size_t bytes) {
    const unsigned char *byte = (const unsigned char *)data;
    crc = ~crc;
    for (size_t i = 0; i < bytes; i++) {
        crc ^= byte[i];
        crc = crc >> 4 ^ remainder_of[crc & 15u];
        crc = crc >> 4 ^ remainder_of[crc & 15u];
    }
    return ~crc;
}

static uint32_t times_x(uint32_t a) {
    return a >> 1 ^ (POLYNOMIAL & (0u - (a & 1u)));
}

/* a times each polynomial of degree below 4: 1 (at 8), x (at 4), x^2 (at 2), x^3 (at 1), and their
 * sums. */
static void multiply(uint32_t a, uint32_t multiple[16]) {
    multiple[0] = 0;
    for (uint32_t n = 8; n != 0; n >>= 1, a = times_x(a))
        multiple[n] = a;
    for (uint32_t n = 1; n < 16; n++)
        multiple[n] = multiple[n & (n - 1u)] ^ multiple[n & (0u - n)];
}

/* By Horner's rule, four coefficients at a time, from x^31 on. */
uint32_t rlvc_crc_shift(uint32_t crc, const uint32_t multiple[16]) {
    uint32_t product = 0;
    for (uint32_t i = 0; i < 8; i++, crc >>= 4)
        product = product >> 4 ^ remainder_of[product & 15u] ^ multiple[crc & 15u];
    return product;
}

/* x^(8 bytes) by squaring: bytes in binary, from the lowest digit. */
void rlvc_crc_shift_by(uint32_t bytes, uint32_t multiple[16]) {
    uint32_t factor = X_0;
    for (uint32_t power = X_8; bytes != 0; bytes >>= 1) {
        multiply(power, multiple);
        if (bytes & 1u)
            factor = rlvc_crc_shift(factor, multiple);
        power = rlvc_crc_shift(power, multiple);
    }
    multiply(factor, multiple);
}
