/* inventory_status.c: dead stems, by the words of an inventory's status column. */
#include "world/inventory.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "scene/latin_names.h"

enum { MOST_WORDS = 64 }; /* more are remarks, and no states */

/* English, German, French, Spanish, Swedish and Finnish. */
static const char *const dead_words[] = {
    "dead", "d", "dead standing", "standing dead", "dead fallen", "fallen dead", "dead tree", "snag", "tot", "abgestorben",
    "tot stehend", "stehend tot", "tot liegend", "liegend tot", "durr", "mort", "morte", "morts", "mort sur pied",
    "mort debout", "muerto", "muerta", "muerto en pie", "dod", "doda", "dott", "kuollut", "kuolleet"};

void wd_inventory_dead_init(struct wd_inventory_dead *dead, const struct wd_scene_inventory *wanted)
{
    *dead = (struct wd_inventory_dead){.wanted = wanted};
    dead->rows = wd_alloc_array(wanted->dead_count + 1, sizeof *dead->rows);
}

static bool means_dead(const char *status)
{
    for (size_t i = 0; i < sizeof dead_words / sizeof *dead_words; i++)
        if (wd_names_alike(status, dead_words[i]))
            return true;
    return false;
}

/* Spellings are listed apart, as the scene is to name each. */
static void note_living(struct wd_inventory_dead *dead, const char *status)
{
    for (size_t i = 0; i < dead->count; i++)
        if (strcasecmp(dead->living[i].word, status) == 0) {
            dead->living[i].rows++;
            return;
        }
    if (dead->count < MOST_WORDS)
        *wd_push(dead->living, dead->count, dead->capacity) = (struct wd_living_word){wd_strdup(status), means_dead(status), 1};
}

bool wd_inventory_is_dead(struct wd_inventory_dead *dead, const char *status)
{
    bool is_dead = dead->wanted->dead_count == 0 && strcasecmp(status, "dead") == 0;
    for (size_t i = 0; i < dead->wanted->dead_count; i++)
        if (strcasecmp(status, dead->wanted->dead[i]) == 0) {
            dead->rows[i]++;
            is_dead = true;
        }
    if (!is_dead && dead->wanted->dead_count == 0)
        note_living(dead, status);
    return is_dead;
}

static void warn_of_no_column(const struct wd_inventory_dead *dead, const struct wd_csv *csv)
{
    char *header = wd_csv_names(csv);
    wd_warn(csv->log, "%s:1: no column for the status was recognised, so no tree is left out as \"%s\"; name it in "
            "\"columns\": {\"status\": \"...\"}; the header has: %s", csv->path, dead->wanted->dead[0], header);
    free(header);
}

static void warn_of_living(const struct wd_inventory_dead *dead, const struct wd_csv *csv, int status, uint64_t dead_rows)
{
    char *counts = wd_strdup(""), *words = wd_strdup(dead_rows > 0 ? "\"dead\"" : "");
    for (size_t i = 0; i < dead->count; i++) {
        const struct wd_living_word *living = &dead->living[i];
        if (!living->means_dead)
            continue;
        char *more = wd_format("%s%s\"%s\" (%" PRIu64 ")", counts, *counts ? ", " : "", living->word, living->rows);
        free(counts);
        counts = more;
        more = wd_format("%s%s\"%s\"", words, *words ? ", " : "", living->word);
        free(words);
        words = more;
    }
    if (*counts)
        wd_warn(csv->log, "%s: column %s: %s counted as living; to leave these out, say \"dead\": [%s]", csv->path,
                csv->header[status], counts, words);
    free(counts);
    free(words);
}

void wd_inventory_dead_warn(const struct wd_inventory_dead *dead, const struct wd_csv *csv, int status,
                            uint64_t dead_rows)
{
    const struct wd_scene_inventory *wanted = dead->wanted;
    if (wanted->dead_count > 0 && status < 0)
        warn_of_no_column(dead, csv);
    for (size_t i = 0; i < wanted->dead_count && status >= 0; i++)
        if (dead->rows[i] == 0)
            wd_warn(csv->log, "%s: no row has the status \"%s\" in column %s, so none is left out by it; is "
                    "the word in \"dead\" right?", csv->path, wanted->dead[i], csv->header[status]);
    warn_of_living(dead, csv, status, dead_rows);
}

void wd_inventory_dead_finish(struct wd_inventory_dead *dead)
{
    for (size_t i = 0; i < dead->count; i++)
        free(dead->living[i].word);
    free(dead->living);
    free(dead->rows);
    *dead = (struct wd_inventory_dead){0};
}
