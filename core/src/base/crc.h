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

#endif
