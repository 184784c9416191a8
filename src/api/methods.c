#include <stdio.h>

#include "scene/keys_reader.h"
#include "scene/methods.h"
#include "weald/renderer.h"

static const struct wd_key *key_at(const struct wd_keys *table, uint32_t index)
{
    const struct wd_key *key = table->keys;
    while (key->name && index--)
        key++;
    return key->name ? key : NULL;
}

bool wd_method_get_info(uint32_t index, struct wd_method_info *info)
{
    const struct wd_key *method = key_at(&wd_scene_method_keys, index);
    *info = (struct wd_method_info){0};
    if (!method)
        return false;
    *info = (struct wd_method_info){method->name, method->doc, method->row};
    return true;
}

bool wd_method_get_option(uint32_t method_index, uint32_t option_index,
                          struct wd_method_option *option)
{
    const struct wd_key *method = key_at(&wd_scene_method_keys, method_index);
    const struct wd_key *key = method ? key_at(method->table, option_index) : NULL;
    *option = (struct wd_method_option){0};
    if (!key)
        return false;
    *option = (struct wd_method_option){
        .name = key->name, .summary = key->doc, .row = key->row, .fallback = key->fallback};
    wd_keys_allowed(key, option->allowed, sizeof option->allowed);
    return true;
}
