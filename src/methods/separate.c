/* Every tree drawn by itself: the baseline of Guerrero 2006 (row G9). Each tree is tested against
 * the frustum and gets a draw call of its own at the level that its distance asks for. */
#include "methods/method.h"

static void separate_finish(void *state, struct wd_gpu *gpu)
{
    (void)gpu;
    wd_selection_finish(state);
}

static void separate_select(void *state, const struct wd_tree_draw *draw)
{
    struct wd_selection *selection = state;
    const struct wd_level_rule rule = wd_level_rule_of(draw->forest, draw->view, draw->pass);
    size_t count = draw->forest->world->tree_count;
    wd_selection_clear(selection);
    for (size_t i = 0; i < count; i++)
        wd_selection_add_tree(selection, draw->forest, draw->view, &rule, (uint32_t)i);
}

static void separate_draw(void *state, const struct wd_tree_draw *draw)
{
    wd_tree_draw_selection(draw, state, WD_DRAW_SINGLE);
}

const struct wd_method wd_method_separate = {
    .name = "separate",
    .cards = true,
    .state_size = sizeof(struct wd_selection),
    .finish = separate_finish,
    .select = separate_select,
    .draw = separate_draw,
};
