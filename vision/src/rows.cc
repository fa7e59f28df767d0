// SPDX-License-Identifier: MIT
#include "rows.h"

namespace rlvc {

extern const RowPasses rows_base;
#ifdef RLVC_ROWS_HAVE_AVX2
extern const RowPasses rows_avx2;
#endif

const RowPasses &row_passes() {
#ifdef RLVC_ROWS_HAVE_AVX2
    if (__builtin_cpu_supports("avx2"))
        return rows_avx2;
#endif
    return rows_base;
}

} // namespace rlvc
