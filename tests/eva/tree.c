/* SPDX-License-Identifier: MIT */
/* The tree: built of any splits that loading lets through, walked, used and grown. Of each shape by
 * itself. */
#include "any.h"
#include "base/arena.h"
#include "rlvc/bits.h"
#include "tree/tree.h"

#define CLASSES 4u

static uint64_t memory[256];

int eva_tree(void) {
    rlvc_arena arena = {(unsigned char *)memory, 0};
    rlvc_domain domain;
    rlvc_tree tree;
    rlvc_split about = {0};
    uint16_t feature = (uint16_t)any_in(0, 3);
    unsigned char percept = (unsigned char)any_in(0, 255);
    uint32_t class_id, classes = each_in(1, CLASSES);
    (void)rlvc_bits_domain(4, &domain);
    rlvc_tree_carve(&tree, &arena, CLASSES + 1u, sizeof feature);
    rlvc_tree_clear(&tree);
    for (uint32_t j = 0; j + 1u < classes; j++) {
        tree.split[j].about = about;
        tree.split[j].about.class_id = each_in(0, j);
        rlvc_tree_feature(&tree, j)[0] = (unsigned char)any_in(0, 3); /* as check_feature asks */
        rlvc_tree_feature(&tree, j)[1] = 0;
    }
    rlvc_tree_build(&tree, classes);
    (void)rlvc_tree_check(&tree);
    (void)rlvc_tree_classify(&tree, &domain, &percept, &class_id);
    about.class_id = each_in(0, classes - 1u);
    rlvc_tree_grow(&tree, rlvc_tree_leaf(&tree, about.class_id), &about, &feature);
    uint32_t node = 0;
    do {
        (void)rlvc_tree_depth(&tree, node);
        node = rlvc_tree_walk(&tree, node);
    } while (node != 0);
    return 0;
}
