/* SPDX-License-Identifier: MIT */
/* CRC-32, as Ethernet, zlib and most microcontrollers' hardware have it: the polynomial 0x04c11db7,
 * lowest bit first, all ones before and inverted after. Of "123456789" it is 0xcbf43926. It finds
 * every change within 32 bits in a row, and misses one in 2^32 of the others. */
#ifndef RLVC_SRC_CRC_H
#define RLVC_SRC_CRC_H

#include <stddef.h>
#include <stdint.h>

/* The CRC of what `crc` is the CRC of (0: nothing) and `bytes` bytes more. O(bytes). */
uint32_t rlvc_crc(uint32_t crc, const void *data, size_t bytes);

/* The CRC of the concatenation AB is that of A, shifted by the bytes of B, xor that of B. So the
 * CRC of the end of a string follows from those of the string and of its beginning. As polynomials
 * with the coefficient of x^0 in the highest bit, to shift is to multiply by x^(8 bytes), modulo
 * that of the CRC. */

/* Makes what rlvc_crc_shift needs: multiples of the factor. O(log bytes). */
void rlvc_crc_shift_by(uint32_t bytes, uint32_t multiple[16]);

/* The CRC, shifted. O(1). */
uint32_t rlvc_crc_shift(uint32_t crc, const uint32_t multiple[16]);

#endif
