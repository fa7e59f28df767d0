/* SPDX-License-Identifier: MIT */
/* Counting interactions (rlvc/counts.h): a part of a log, as columns of bits, becomes rows and
 * pairs.
 *
 * For each interaction: the cells of s and s' are gathered from their bytes by tables of 256, one
 * for each byte that holds a bit of a cell. The row is found by its hash in an open-addressed
 * index. The bits of s are added to eight counters of 8 bits a word: another table spreads a byte
 * to eight bytes. After 255 additions these go into the row's counts. For pairs of features, s and
 * s' wait until there are 64 of the same cell and action; then they are transposed, so that a word
 * has one feature of all 64, and each pair of features costs an AND and a count of bits. */
#include "shim.h"

#include <string.h>

#define WAITING 64u     /* interactions that a pair collects */
#define PENDING_MAX 255 /* additions that a counter of 8 bits takes */
#define EMPTY UINT32_MAX

#if defined(__x86_64__) && defined(__GNUC__)
#define FAST_POPCOUNT __attribute__((target("popcnt")))
#endif

static uint64_t mix(uint64_t h) {
    h ^= h >> 32;
    h *= 0xd6e8feb86659fd93u;
    h ^= h >> 32;
    return h;
}

static uint32_t words_of(uint32_t bits) {
    return (bits + 63u) / 64u;
}

static uint32_t lanes_of(const rlvc_shim_table *table) {
    return (table->features + 7u) / 8u;
}

/* ------------------------------------------------------------------ pairs of features */

/* Transposes 64 words of 64 bits, by halves of halves. */
static void transpose(uint64_t word[64]) {
    uint64_t low = 0x00000000ffffffffu;
    for (uint32_t j = 32; j != 0; j >>= 1, low ^= low << j)
        for (uint32_t k = 0; k < 64u; k = (k + j + 1u) & ~j) {
            uint64_t differ = ((word[k] >> j) ^ word[k + j]) & low;
            word[k] ^= differ << j;
            word[k + j] ^= differ;
        }
}

/* The waiting percepts, `words` apart in `from`, as columns: word f has feature f of all. */
static void columns_of(const uint64_t *from, uint32_t words, uint32_t waiting, uint64_t *column) {
    for (uint32_t w = 0; w < words; w++) {
        for (uint32_t i = 0; i < WAITING; i++)
            column[64u * w + i] = i < waiting ? from[(size_t)i * words + w] : 0;
        transpose(column + 64u * w);
    }
}

static inline void count_columns(uint64_t *to, const uint64_t *now, const uint64_t *next,
                                 uint32_t features) {
    const size_t width = features + 1u;
    for (uint32_t g = 0; g < features; g++)
        to[g + 1u] += (uint64_t)__builtin_popcountll(next[g]);
    for (uint32_t f = 0; f < features; f++) {
        uint64_t *row = to + (f + 1u) * width;
        uint64_t column = now[f];
        row[0] += (uint64_t)__builtin_popcountll(column);
        for (uint32_t g = 0; g < features; g++)
            row[g + 1u] += (uint64_t)__builtin_popcountll(column & next[g]);
    }
}

#ifdef FAST_POPCOUNT
FAST_POPCOUNT static void count_columns_fast(uint64_t *to, const uint64_t *now,
                                             const uint64_t *next, uint32_t features) {
    count_columns(to, now, next, features);
}
#endif

/* Counts what waits for a pair. */
static void flush_pair(rlvc_shim_table *table, uint32_t pair) {
    uint64_t now[RLVC_SHIM_FOLLOW_MAX], next[RLVC_SHIM_FOLLOW_MAX];
    const uint32_t words = words_of(table->features), waiting = table->waiting[pair];
    const size_t width = table->features + 1u, at = (size_t)pair * WAITING * words;
    uint64_t *to = table->follow + pair * width * width;
    columns_of(table->now + at, words, waiting, now);
    columns_of(table->next + at, words, waiting, next);
    to[0] += waiting;
    table->waiting[pair] = 0;
#ifdef FAST_POPCOUNT
    if (__builtin_cpu_supports("popcnt")) {
        count_columns_fast(to, now, next, table->features);
        return;
    }
#endif
    count_columns(to, now, next, table->features);
}

static void wait_for(rlvc_shim_table *table, uint32_t pair, const unsigned char *now,
                     const unsigned char *next) {
    const uint32_t words = words_of(table->features), bytes = table->percept_bytes;
    size_t at = ((size_t)pair * WAITING + table->waiting[pair]) * words;
    table->now[at + words - 1u] = 0;
    table->next[at + words - 1u] = 0;
    memcpy(table->now + at, now, bytes);
    memcpy(table->next + at, next, bytes);
    if (++table->waiting[pair] == WAITING)
        flush_pair(table, pair);
}

/* ------------------------------------------------------------------ rows and pairs */

/* The pair of a cell and action; a new one if need be, EMPTY if there is no room. */
static uint32_t pair_of(rlvc_shim_table *table, uint64_t now, uint32_t action) {
    const uint32_t mask = 2u * table->pairs_max - 1u;
    uint32_t at = (uint32_t)mix(now * 0x9e3779b97f4a7c15u + action) & mask;
    for (;; at = (at + 1u) & mask) {
        uint32_t pair = table->pair_index[at];
        if (pair == EMPTY) {
            const rlvc_count_pair made = {now, action, 0};
            if (table->pairs == table->pairs_max)
                return EMPTY;
            table->pair_index[at] = table->pairs;
            table->pair[table->pairs] = made;
            return table->pairs++;
        }
        if (table->pair[pair].now == now && table->pair[pair].action == action)
            return pair;
    }
}

static uint32_t bits_of(float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* The row like `wanted` but for its count; a new one if need be, EMPTY if there is no room. */
static uint32_t row_of(rlvc_shim_table *table, const rlvc_count_row *wanted) {
    const uint32_t mask = 2u * table->rows_max - 1u;
    const uint64_t rest = (uint64_t)bits_of(wanted->reward) << 16 | (uint64_t)wanted->action << 1 |
                          wanted->terminated;
    uint32_t at =
        (uint32_t)mix(wanted->now * 0x9e3779b97f4a7c15u ^ mix(wanted->next + (rest << 8))) & mask;
    for (;; at = (at + 1u) & mask) {
        uint32_t row = table->row_index[at];
        if (row == EMPTY)
            break;
        const rlvc_count_row *found = &table->row[row];
        if (found->now == wanted->now && found->next == wanted->next &&
            bits_of(found->reward) == bits_of(wanted->reward) && found->action == wanted->action &&
            found->terminated == wanted->terminated)
            return row;
    }
    if (table->rows == table->rows_max)
        return EMPTY;
    uint32_t pair = pair_of(table, wanted->now, wanted->action);
    if (pair == EMPTY)
        return EMPTY;
    table->row_index[at] = table->rows;
    table->row[table->rows] = *wanted;
    table->row[table->rows].count = 0;
    table->row_pair[table->rows] = pair;
    return table->rows++;
}

/* Adds a row's counters of 8 bits to its counts. */
static void flush_row(rlvc_shim_table *table, uint32_t row) {
    unsigned char *counter = (unsigned char *)(table->lanes + (size_t)row * lanes_of(table));
    uint64_t *with = table->with + (size_t)row * table->features;
    for (uint32_t f = 0; f < table->features; f++)
        with[f] += counter[f];
    memset(counter, 0, lanes_of(table) * sizeof *table->lanes);
    table->pending[row] = 0;
}

static uint64_t cell_of(const rlvc_shim_table *table, const unsigned char *percept) {
    uint64_t cell = 0;
    for (uint32_t i = 0; i < table->gather_bytes; i++)
        cell |= table->gather[256u * i + percept[table->gather_byte[i]]];
    return cell;
}

/* ------------------------------------------------------------------ the log */

static rlvc_status check(const rlvc_shim_table *table, const rlvc_shim_columns *columns, size_t i) {
    if (columns->actions[i] >= table->actions || columns->ends[i] > RLVC_TRUNCATED)
        return RLVC_E_RANGE;
    return columns->rewards[i] >= -RLVC_REWARD_MAX && columns->rewards[i] <= RLVC_REWARD_MAX
               ? RLVC_OK
               : RLVC_E_REWARD;
}

static rlvc_status count_one(rlvc_shim_table *table, const rlvc_shim_columns *columns, size_t i) {
    const uint32_t bytes = table->percept_bytes, lanes = lanes_of(table);
    const unsigned char *now = columns->percepts + i * bytes;
    const unsigned char *next =
        columns->ends[i] == RLVC_TERMINATED ? NULL : columns->next + i * bytes;
    const rlvc_count_row wanted = {0,
                                   cell_of(table, now),
                                   next ? cell_of(table, next) : 0,
                                   columns->keys[i] + 0.0f, /* -0 is 0 */
                                   columns->actions[i],
                                   next == NULL,
                                   {0, 0}};
    uint32_t row = row_of(table, &wanted);
    if (row == EMPTY)
        return RLVC_E_MEMORY;
    table->row[row].count++;
    uint64_t *lane = table->lanes + (size_t)row * lanes;
    for (uint32_t b = 0; b < lanes; b++)
        lane[b] += table->spread[now[b]];
    if (++table->pending[row] == PENDING_MAX)
        flush_row(table, row);
    if (table->follow && next)
        wait_for(table, table->row_pair[row], now, next);
    if (table->reward)
        rlvc_exact_sum_add(&table->reward[table->row_pair[row]], columns->rewards[i], 1);
    return RLVC_OK;
}

rlvc_status rlvc_shim_count(rlvc_shim_table *table, const rlvc_shim_columns *columns,
                            size_t *done) {
    rlvc_status status = RLVC_OK;
    for (; *done < columns->count; ++*done) {
        status = check(table, columns, *done);
        if (status == RLVC_OK)
            status = count_one(table, columns, *done);
        if (status != RLVC_OK)
            break;
    }
    return status;
}

void rlvc_shim_count_end(rlvc_shim_table *table) {
    for (uint32_t row = 0; row < table->rows; row++)
        flush_row(table, row);
    for (uint32_t pair = 0; table->follow && pair < table->pairs; pair++)
        flush_pair(table, pair);
}

/* ------------------------------------------------------------------ adding tables */

static void add_up(uint64_t *to, const uint64_t *from, size_t count) {
    for (size_t i = 0; i < count; i++)
        to[i] += from[i];
}

rlvc_status rlvc_shim_count_add(rlvc_shim_table *table, const rlvc_counts *part) {
    const size_t features = table->features, width = features + 1u;
    for (uint32_t i = 0; i < part->rows; i++) {
        uint32_t row = row_of(table, &part->row[i]);
        if (row == EMPTY)
            return RLVC_E_MEMORY;
        table->row[row].count += part->row[i].count;
        add_up(table->with + row * features, part->with + i * features, features);
    }
    for (uint32_t i = 0; i < part->pairs; i++) {
        uint32_t pair = pair_of(table, part->pair[i].now, part->pair[i].action);
        if (pair == EMPTY)
            return RLVC_E_MEMORY;
        if (table->follow)
            add_up(table->follow + pair * width * width, part->follow + i * width * width,
                   width * width);
        if (table->reward)
            rlvc_exact_sum_join(&table->reward[pair], &part->reward[i]);
    }
    return RLVC_OK;
}
