/* SPDX-License-Identifier: MIT */
/* The tree as text, DOT and JSON (section 4.3): one walk in pre-order, without recursion. */
#include "rlvc/float_rules.h"

#include "print.h"

#include "../base/method.h"

typedef rlvc_printer printer;

static void string(printer *p, const char *s) {
    rlvc_text_string(&p->text, s);
}

static void number(printer *p, const char *before, uint32_t n) {
    rlvc_text_string(&p->text, before);
    rlvc_text_uint(&p->text, n);
}

static void real(printer *p, const char *before, float x) {
    rlvc_text_string(&p->text, before);
    rlvc_text_float(&p->text, x, 9);
}

/* The name of the feature that an internal node tests. */
static void name(printer *p, uint32_t node) {
    char text[RLVC_NAME_BYTES];
    const rlvc_domain *domain = p->domain;
    const void *feature = rlvc_tree_feature(p->tree, rlvc_tree_split_of(p->tree, node));
    text[0] = '\0';
    if (p->text.status == RLVC_OK && domain->name(domain->ctx, feature, text, sizeof text) != 0)
        p->text.status = RLVC_E_CALLBACK;
    text[sizeof text - 1u] = '\0';
    string(p, text);
}

/* Interactions behind the values of a class. */
static uint32_t tried(const rlvc_values *values, uint32_t class_id) {
    uint32_t sum = 0;
    for (uint32_t a = 0; a < values->actions; a++)
        sum += values->tried[rlvc_values_pair(values, class_id, a)];
    return sum;
}

/* ------------------------------------------------------------------ text */

static void print_text(printer *p, uint32_t node) {
    const rlvc_tree *tree = p->tree;
    for (uint32_t depth = rlvc_tree_depth(tree, node); depth > 0; depth--)
        string(p, "  ");
    if (node > 0)
        string(p, node % 2u == 0 ? "yes: " : "no: ");
    if (!rlvc_tree_is_leaf(tree, node)) {
        name(p, node);
        string(p, "?\n");
        return;
    }
    uint32_t c = rlvc_tree_class(tree, node);
    if (!p->values) {
        number(p, "action ", p->policy[c]);
        string(p, "\n");
        return;
    }
    number(p, "class ", c);
    number(p, ": action ", p->policy[c]);
    real(p, ", value ", p->values->value[c]);
    number(p, ", ", tried(p->values, c));
    string(p, " interactions\n");
}

/* ------------------------------------------------------------------ DOT */

static void print_dot(printer *p, uint32_t node) {
    const rlvc_tree *tree = p->tree;
    number(p, "  n", node);
    if (rlvc_tree_is_leaf(tree, node)) {
        uint32_t c = rlvc_tree_class(tree, node);
        string(p, " [shape=box, label=\"");
        if (p->values)
            number(p, "class ", c);
        number(p, p->values ? "\\naction " : "action ", p->policy[c]);
        if (p->values)
            real(p, "\\nvalue ", p->values->value[c]);
        string(p, "\"];\n");
        return;
    }
    string(p, " [label=\"");
    name(p, node);
    string(p, "\"];\n");
    for (uint32_t side = 0; side < 2; side++) {
        number(p, "  n", node);
        number(p, " -> n", tree->node[node] + side);
        string(p, side ? " [label=\"yes\"];\n" : " [label=\"no\", style=dashed];\n");
    }
}

/* ------------------------------------------------------------------ JSON */

static void print_json_class(printer *p, uint32_t c) {
    const rlvc_values *values = p->values;
    number(p, ", \"class\": ", c);
    number(p, ", \"action\": ", p->policy[c]);
    if (!values) {
        string(p, "}");
        return;
    }
    real(p, ", \"value\": ", values->value[c]);
    for (uint32_t a = 0; a < values->actions; a++)
        real(p, a ? ", " : ", \"q\": [", values->q[rlvc_values_pair(values, c, a)]);
    for (uint32_t a = 0; a < values->actions; a++)
        number(p, a ? ", " : "], \"samples\": [", values->tried[rlvc_values_pair(values, c, a)]);
    string(p, "]}");
}

static void print_json_test(printer *p, uint32_t node) {
    const rlvc_tree *tree = p->tree;
    const rlvc_split *about = &tree->split[rlvc_tree_split_of(tree, node)].about;
    string(p, ", \"test\": \"");
    name(p, node);
    number(p, "\", \"absent\": ", tree->node[node]);
    number(p, ", \"present\": ", tree->node[node] + 1u);
    if (!p->values) {
        string(p, "}");
        return;
    }
    number(p, ", \"split\": ", rlvc_tree_split_of(tree, node));
    number(p, ", \"split_class\": ", about->class_id);
    number(p, ", \"step\": ", about->step);
    number(p, ", \"action\": ", about->action);
    number(p, ", \"samples\": ", about->samples);
    real(p, ", \"log_tests\": ", about->log_tests);
    real(p, ", \"score\": ", about->score);
    real(p, ", \"log_p\": ", about->log_p);
    string(p, "}");
}

static void print_json(printer *p, uint32_t node) {
    if (node > 0)
        string(p, ",\n");
    number(p, "  {\"node\": ", node);
    if (rlvc_tree_is_leaf(p->tree, node))
        print_json_class(p, rlvc_tree_class(p->tree, node));
    else
        print_json_test(p, node);
}

/* ------------------------------------------------------------------ all of them */

static void print_nodes(printer *p, uint32_t format) {
    uint32_t node = 0;
    do {
        if (format == RLVC_PRINT_TEXT)
            print_text(p, node);
        else if (format == RLVC_PRINT_DOT)
            print_dot(p, node);
        else
            print_json(p, node);
        node = rlvc_tree_walk(p->tree, node);
    } while (node != 0 && p->text.status == RLVC_OK);
}

void rlvc_printer_run(printer *p, uint32_t format) {
    if (format == RLVC_PRINT_DOT) {
        string(p, "digraph rlvc {\n  node [fontname=\"sans-serif\"];\n");
    } else if (format == RLVC_PRINT_JSON) {
        number(p, "{\"classes\": ", p->tree->classes);
        number(p, ", \"actions\": ", p->actions);
        if (p->values)
            number(p, ", \"step\": ", p->step);
        string(p, ", \"nodes\": [\n");
    }
    print_nodes(p, format);
    if (format == RLVC_PRINT_DOT)
        string(p, "}\n");
    else if (format == RLVC_PRINT_JSON)
        string(p, "\n]}\n");
}

rlvc_status rlvc_print(rlvc_agent *agent, uint32_t format, rlvc_write write, void *ctx) {
    rlvc_learnt learnt;
    if (!agent || !write)
        return RLVC_E_NULL;
    rlvc_view(agent, &learnt);
    if (*learnt.busy)
        return RLVC_E_REENTERED;
    if (format > RLVC_PRINT_JSON)
        return RLVC_E_RANGE;
    printer p = {{write, ctx, RLVC_OK}, learnt.domain,  learnt.tree, learnt.policy,
                 learnt.values,         learnt.actions, learnt.step};
    *learnt.busy = 1;
    rlvc_printer_run(&p, format);
    *learnt.busy = 0;
    return p.text.status;
}
