/* SPDX-License-Identifier: MIT */
/* Counting interactions (rlvc/counts.h): a part of a log, as columns of bits, becomes rows.
 *
 * For each interaction: the cells of s and s' are gathered from their bytes by tables of 256, one
 * for each byte that holds a bit of a cell. The row is found by its hash in an open-addressed
 * index. The bits of s, of s' and of both are added to eight counters of 8 bits a word: another
 * table spreads a byte to eight bytes. After 255 additions these go into the row's counts. */
#include "shim.h"

#include <string.h>

#define PENDING_MAX 255 /* additions that a counter of 8 bits takes */
#define EMPTY UINT32_MAX

static uint64_t mix(uint64_t h) {
    h ^= h >> 32;
    h *= 0xd6e8feb86659fd93u;
    h ^= h >> 32;
    return h;
}

static uint32_t lanes_of(const rlvc_shim_table *table) {
    return (table->features + 7u) / 8u;
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
    if (table->reward) {
        uint32_t pair = pair_of(table, wanted->now, wanted->action);
        if (pair == EMPTY)
            return EMPTY;
        table->row_pair[table->rows] = pair;
    }
    table->row_index[at] = table->rows;
    table->row[table->rows] = *wanted;
    table->row[table->rows].count = 0;
    return table->rows++;
}

static void add_counters(uint64_t *counts, const unsigned char *counter, uint32_t features) {
    for (uint32_t f = 0; f < features; f++)
        counts[f] += counter[f];
}

/* Adds a row's counters of 8 bits to its counts. */
static void flush_row(rlvc_shim_table *table, uint32_t row) {
    const uint32_t features = table->features, lanes = lanes_of(table);
    const uint32_t kinds = table->follow ? 3u : 1u;
    uint64_t *lane = table->lanes + (size_t)row * kinds * lanes;
    add_counters(table->with + (size_t)row * features, (unsigned char *)lane, features);
    for (uint32_t kind = 1; kind < kinds; kind++)
        add_counters(table->follow + ((size_t)row * 2u + kind - 1u) * features,
                     (unsigned char *)(lane + (size_t)kind * lanes), features);
    memset(lane, 0, (size_t)kinds * lanes * sizeof *lane);
    table->pending[row] = 0;
}

/* Adds the bits of s, of s' and of both to a row's counters. */
static inline void add_bits(const rlvc_shim_table *table, uint32_t row, const unsigned char *now,
                            const unsigned char *next) {
    const uint32_t lanes = lanes_of(table);
    const uint64_t *spread = table->spread;
    if (!table->follow) {
        uint64_t *lane = table->lanes + (size_t)row * lanes;
        for (uint32_t b = 0; b < lanes; b++)
            lane[b] += spread[now[b]];
        return;
    }
    uint64_t *lane = table->lanes + (size_t)row * 3u * lanes;
    for (uint32_t b = 0; b < lanes; b++)
        lane[b] += spread[now[b]];
    for (uint32_t b = 0; next && b < lanes; b++) {
        lane[lanes + b] += spread[next[b]];
        lane[2u * lanes + b] += spread[now[b] & next[b]];
    }
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
    const uint32_t bytes = table->percept_bytes;
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
    add_bits(table, row, now, next);
    if (++table->pending[row] == PENDING_MAX)
        flush_row(table, row);
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
}

/* ------------------------------------------------------------------ adding tables */

static void add_up(uint64_t *to, const uint64_t *from, size_t count) {
    for (size_t i = 0; i < count; i++)
        to[i] += from[i];
}

rlvc_status rlvc_shim_count_add(rlvc_shim_table *table, const rlvc_counts *part) {
    const size_t features = table->features;
    for (uint32_t i = 0; i < part->rows; i++) {
        uint32_t row = row_of(table, &part->row[i]);
        if (row == EMPTY)
            return RLVC_E_MEMORY;
        table->row[row].count += part->row[i].count;
        add_up(table->with + row * features, part->with + i * features, features);
        if (table->follow)
            add_up(table->follow + row * 2u * features, part->follow + i * 2u * features,
                   2u * features);
    }
    for (uint32_t i = 0; i < part->pairs; i++) {
        uint32_t pair = pair_of(table, part->pair[i].now, part->pair[i].action);
        if (pair == EMPTY)
            return RLVC_E_MEMORY;
        rlvc_exact_sum_join(&table->reward[pair], &part->reward[i]);
    }
    return RLVC_OK;
}
