#include "world/inventory.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"

static const char *mapped_name(const struct wd_scene_inventory *wanted, const char *name)
{
    for (size_t i = 0; i < wanted->species_count; i++)
        if (strcmp(wanted->species[i].name, name) == 0)
            return wanted->species[i].value;
    for (size_t i = 0; i < wanted->species_count; i++)
        if (strcasecmp(wanted->species[i].name, name) == 0)
            return wanted->species[i].value;
    return NULL;
}

/* The scene's own name for a species, or its Latin name. */
static int scene_species(const struct wd_scene *scene, const char *name)
{
    for (size_t i = 0; i < scene->species_file_count; i++)
        if (strcasecmp(scene->species_files[i].name, name) == 0)
            return (int)i;
    for (size_t i = 0; i < scene->species_file_count; i++)
        if (scene->species[i].latin && strcasecmp(scene->species[i].latin, name) == 0)
            return (int)i;
    return -1;
}

/* `any`: it has no name of its own there. */
static int look_up(const struct wd_species_names *names, const char *name, bool *any)
{
    const char *mapped = mapped_name(names->wanted, name);
    *any = false;
    if (mapped)
        return wd_scene_find_species(names->scene, mapped);
    int species = *name ? scene_species(names->scene, name) : -1;
    if (species >= 0)
        return species;
    mapped = mapped_name(names->wanted, "*");
    *any = mapped != NULL;
    return mapped ? wd_scene_find_species(names->scene, mapped) : -1;
}

size_t wd_species_names_find(struct wd_species_names *names, const char *name, uint64_t line)
{
    for (size_t i = 0; i < names->count; i++)
        if (strcmp(names->names[i].name, name) == 0) {
            names->names[i].count++;
            return i;
        }
    bool any;
    int species = look_up(names, name, &any);
    struct wd_species_name *added = wd_push(names->names, names->count, names->capacity);
    *added = (struct wd_species_name){wd_strdup(name), species, any, 1, line};
    return names->count - 1;
}

static int most_frequent_first(const void *first, const void *second)
{
    const struct wd_species_name *a = first, *b = second;
    if (a->count != b->count)
        return a->count > b->count ? -1 : 1;
    return strcmp(a->name, b->name);
}

/* Names, the most frequent first, with their counts; free() it. */
static char *listed(struct wd_species_name *of, size_t count, size_t most)
{
    char *list = wd_strdup("");
    qsort(of, count, sizeof *of, most_frequent_first);
    for (size_t i = 0; i < count && i < most; i++) {
        char *longer = wd_format("%s%s\"%s\" (%" PRIu64 ", from line %" PRIu64 ")", list, i ? ", " : "",
                                 *of[i].name ? of[i].name : "(empty)", of[i].count, of[i].line);
        free(list);
        list = longer;
    }
    char *all = wd_format("%s%s", list, count > most ? ", ..." : "");
    free(list);
    return all;
}

/* What "*" stands for is told, as several species may have become one. */
static void tell_any(const struct wd_species_names *names, const char *path, const struct wd_log *log)
{
    struct wd_species_name *any = wd_alloc_array(names->count + 1, sizeof *any);
    size_t count = 0;
    for (size_t i = 0; i < names->count; i++)
        if (names->names[i].any && *names->names[i].name)
            any[count++] = names->names[i];
    char *list = listed(any, count, 5);
    if (count > 0)
        wd_info(log, "inventory %s: \"*\" stands for %zu species, all drawn as %s: %s", path, count,
                names->scene->species_files[any[0].species].name, list);
    free(list);
    free(any);
}

bool wd_species_names_check(const struct wd_species_names *names, const char *path, const char *column,
                            const struct wd_log *log)
{
    struct wd_species_name *missing = wd_alloc_array(names->count + 1, sizeof *missing);
    size_t count = 0;
    for (size_t i = 0; i < names->count; i++)
        if (names->names[i].species < 0)
            missing[count++] = names->names[i];
    char *list = listed(missing, count, 20);
    if (count > 0)
        wd_error(log, "%s:%" PRIu64 ": column %s: %zu species names are not mapped to a species of the scene: "
                 "%s; name each in \"species\", or \"*\" for any other", path, missing[0].line, column, count, list);
    else
        tell_any(names, path, log);
    free(list);
    free(missing);
    return count == 0;
}

void wd_species_names_finish(struct wd_species_names *names)
{
    for (size_t i = 0; i < names->count; i++)
        free(names->names[i].name);
    free(names->names);
    *names = (struct wd_species_names){0};
}
