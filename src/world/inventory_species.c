#include "world/inventory.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <xxhash.h>

#include "base/memory.h"
#include "scene/latin_names.h"

/* Of what the inventory maps, without "*"; the more alike the better. wanted->species_count: it is not mapped. */
static size_t find_mapped(const struct wd_scene_inventory *wanted, const char *name)
{
    size_t count = wanted->species_count;
    for (size_t i = 0; i < count; i++)
        if (strcmp(wanted->species[i].name, name) == 0)
            return i;
    for (size_t i = 0; i < count; i++)
        if (strcasecmp(wanted->species[i].name, name) == 0)
            return i;
    for (size_t i = 0; i < count; i++)
        if (wd_names_alike(wanted->species[i].name, name))
            return i;
    for (size_t i = 0; i < count; i++)
        if (wd_name_is_latin(name, wanted->species[i].name))
            return i;
    return count;
}

/* The scene's own name for a species, or its Latin name. */
static int scene_species(const struct wd_scene *scene, const char *name)
{
    for (size_t i = 0; i < scene->species_file_count; i++)
        if (strcasecmp(scene->species_files[i].name, name) == 0)
            return (int)i;
    for (size_t i = 0; i < scene->species_file_count; i++)
        if (wd_names_alike(scene->species_files[i].name, name))
            return (int)i;
    for (size_t i = 0; i < scene->species_file_count; i++)
        if (scene->species[i].latin && wd_name_is_latin(name, scene->species[i].latin))
            return (int)i;
    return -1;
}

/* `any`: it has no name of its own there. */
static int look_up(const struct wd_species_names *names, const char *name, bool *any)
{
    const struct wd_scene_inventory *wanted = names->wanted;
    size_t mapped = find_mapped(wanted, name);
    *any = false;
    if (mapped < wanted->species_count)
        return wd_scene_find_species(names->scene, wanted->species[mapped].value);
    int species = *name ? scene_species(names->scene, name) : -1;
    if (species >= 0)
        return species;
    mapped = find_mapped(wanted, "*");
    *any = mapped < wanted->species_count;
    return *any ? wd_scene_find_species(names->scene, wanted->species[mapped].value) : -1;
}

/* The slot of a name, or the free one for it. */
static size_t *slot_of(const struct wd_species_names *names, const char *name)
{
    size_t at = (size_t)XXH64(name, strlen(name), 0) & (names->slot_count - 1);
    while (names->slots[at] && strcmp(names->names[names->slots[at] - 1].name, name) != 0)
        at = (at + 1) & (names->slot_count - 1);
    return &names->slots[at];
}

/* A column taken by mistake may have another name in each of its rows. */
static void make_slots(struct wd_species_names *names)
{
    free(names->slots);
    names->slot_count = names->slot_count ? 2 * names->slot_count : 256;
    names->slots = wd_alloc_array(names->slot_count, sizeof *names->slots);
    for (size_t i = 0; i < names->count; i++)
        *slot_of(names, names->names[i].name) = i + 1;
}

size_t wd_species_names_find(struct wd_species_names *names, const char *name, uint64_t line)
{
    if (2 * names->count >= names->slot_count)
        make_slots(names);
    size_t *slot = slot_of(names, name);
    if (*slot) {
        names->names[*slot - 1].count++;
        return *slot - 1;
    }
    bool any;
    int species = look_up(names, name, &any);
    struct wd_species_name *added = wd_push(names->names, names->count, names->capacity);
    *added = (struct wd_species_name){wd_strdup(name), species, any, 1, line};
    *slot = names->count;
    return names->count - 1;
}

static int most_frequent_first(const void *first, const void *second)
{
    const struct wd_species_name *a = first, *b = second;
    if (a->count != b->count)
        return a->count > b->count ? -1 : 1;
    return strcmp(a->name, b->name);
}

/* Puts `longer` in the place of the list. */
static void take_list(char **list, char *longer)
{
    free(*list);
    *list = longer;
}

/* Names, the most frequent first, with their counts; free() it. */
static char *listed(struct wd_species_name *of, size_t count, size_t most)
{
    char *list = wd_strdup("");
    qsort(of, count, sizeof *of, most_frequent_first);
    for (size_t i = 0; i < count && i < most; i++)
        take_list(&list, wd_format("%s%s\"%s\" (%" PRIu64 ", from line %" PRIu64 ")", list, i ? ", " : "",
                                   *of[i].name ? of[i].name : "(empty)", of[i].count, of[i].line));
    take_list(&list, wd_format("%s%s", list, count > most ? ", ..." : ""));
    return list;
}

/* Which of the names are Latin ones of installed species, as `; "A b" is called "c" here: add {"A b": "c"}`; ""
 * where none is. free() it. */
static char *called_here(const struct wd_species_names *names, const struct wd_species_name *of, size_t count, size_t most)
{
    struct wd_species_folders folders;
    struct wd_latin_names latin;
    char *list = wd_strdup(""), *hint = wd_strdup("");
    wd_species_folders_init(&folders, names->scene->path);
    wd_latin_names_init(&latin, &folders);
    for (size_t i = 0; i < count && i < most; i++) {
        const struct wd_latin_name *found = wd_name_has_words(of[i].name) ? wd_latin_names_find(&latin, of[i].name) : NULL;
        if (!found)
            continue;
        take_list(&list, wd_format("%s%s\"%s\": \"%s\"", list, *list ? ", " : "", of[i].name, found->name));
        if (!*hint)
            take_list(&hint, wd_format("; \"%s\" is called \"%s\" here: add ", of[i].name, found->name));
    }
    if (*hint)
        take_list(&hint, wd_format("%s{%s}", hint, list));
    wd_latin_names_finish(&latin);
    wd_species_folders_finish(&folders);
    free(list);
    return hint;
}

/* What "*" stands for is told, as several species may have become one. */
static void tell_any(const struct wd_species_names *names, const char *path, const struct wd_log *log)
{
    enum { MOST = 5 };
    struct wd_species_name *any = wd_alloc_array(names->count + 1, sizeof *any);
    size_t count = 0;
    for (size_t i = 0; i < names->count; i++)
        if (names->names[i].any && *names->names[i].name)
            any[count++] = names->names[i];
    if (count > 0) {
        char *list = listed(any, count, MOST), *hint = called_here(names, any, count, MOST);
        wd_info(log, "inventory %s: \"*\" stands for %zu species, all drawn as %s: %s%s", path, count,
                names->scene->species_files[any[0].species].name, list, hint);
        free(list);
        free(hint);
    }
    free(any);
}

/* Names that are mapped for nothing may be misspelt. */
static void warn_of_unused(const struct wd_species_names *names, const char *path, const char *column,
                           const struct wd_log *log)
{
    const struct wd_scene_inventory *wanted = names->wanted;
    bool *used = wd_alloc_array(wanted->species_count + 1, sizeof *used);
    for (size_t i = 0; i < names->count; i++)
        used[find_mapped(wanted, names->names[i].name)] = true;
    char *list = wd_strdup("");
    for (size_t i = 0; i < wanted->species_count; i++)
        if (!used[i] && strcmp(wanted->species[i].name, "*") != 0)
            take_list(&list, wd_format("%s%s\"%s\"", list, *list ? ", " : "", wanted->species[i].name));
    if (*list && *column)
        wd_warn(log, "%s: no living tree is called %s in column %s, as \"species\" says; is that spelt as there?", path,
                list, column);
    free(list);
    free(used);
}

bool wd_species_names_check(const struct wd_species_names *names, const char *path, const char *column,
                            const struct wd_log *log)
{
    enum { MOST = 20 };
    struct wd_species_name *missing = wd_alloc_array(names->count + 1, sizeof *missing);
    size_t count = 0;
    for (size_t i = 0; i < names->count; i++)
        if (names->names[i].species < 0)
            missing[count++] = names->names[i];
    if (count > 0) {
        char *list = listed(missing, count, MOST), *hint = called_here(names, missing, count, MOST);
        wd_error(log, "%s:%" PRIu64 ": column %s: %zu species names are not mapped to a species of the scene: "
                 "%s; name each in \"species\", or \"*\" for any other%s", path, missing[0].line, column, count, list, hint);
        free(list);
        free(hint);
    } else {
        warn_of_unused(names, path, column, log);
        tell_any(names, path, log);
    }
    free(missing);
    return count == 0;
}

static bool maps_to_one(const struct wd_scene_inventory *wanted)
{
    for (size_t i = 1; i < wanted->species_count; i++)
        if (strcmp(wanted->species[i].value, wanted->species[0].value) != 0)
            return false;
    return wanted->species_count > 0;
}

/* A mapping to several species is for a column: without one, all would become of one in silence. */
static bool check_mapping(const struct wd_species_names *names, const struct wd_csv *csv)
{
    const struct wd_scene_inventory *wanted = names->wanted;
    bool any = find_mapped(wanted, "*") < wanted->species_count;
    if (wanted->species_count == 0 || (any && wanted->species_count == 1))
        return true;
    char *header = wd_csv_names(csv);
    const char *said = "no column for the species was recognised, so \"species\" cannot tell the trees apart; name it in "
                       "\"columns\": {\"species\": \"...\"}";
    bool one = maps_to_one(wanted);
    if (one && names->scene->species_file_count == 1)
        wd_warn(csv->log, "%s:1: %s; all trees are \"%s\"; the header has: %s", csv->path, said, wanted->species[0].value,
                header);
    else if (!one)
        wd_error(csv->log, "%s:1: %s, or give one species for all as \"*\" alone; the header has: %s", csv->path, said,
                 header);
    free(header);
    return one;
}

bool wd_species_names_without_column(struct wd_species_names *names, const struct wd_csv *csv)
{
    if (!check_mapping(names, csv))
        return false;
    if (names->scene->species_file_count == 1) {
        struct wd_species_name *only = wd_push(names->names, names->count, names->capacity);
        *only = (struct wd_species_name){.name = wd_strdup("")};
        return true;
    }
    size_t any = wd_species_names_find(names, "", 1);
    if (names->names[any].species >= 0)
        return true;
    char *header = wd_csv_names(csv);
    wd_error(csv->log, "%s:1: no column for the species was recognised; name it in columns.species, or give one species for "
             "all as \"*\"; the header has: %s", csv->path, header);
    free(header);
    return false;
}

void wd_species_names_finish(struct wd_species_names *names)
{
    for (size_t i = 0; i < names->count; i++)
        free(names->names[i].name);
    free(names->names);
    free(names->slots);
    *names = (struct wd_species_names){0};
}
