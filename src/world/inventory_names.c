#include "world/inventory_names.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/utf8.h"

/* English, German, French, Spanish, Swedish and Finnish, as plain() has them; a unit may follow each. */
static const char *const x_names[] = {
    "x", "east", "easting", "xutm", "utmx", "utme", "gx", "px", "xcoord", "coordx", "xcoordinate", "pointx", "lon", "long",
    "lng", "longitude", "longitud", "rechtswert", "ostwert", "xkoordinate", "xl93", "xlambert93", "xlambert", "coordonneex",
    "este", "utmeste", "coordenadax", "ostkoordinat", "itakoordinaatti", NULL};
static const char *const y_names[] = {
    "y", "north", "northing", "yutm", "utmy", "utmn", "gy", "py", "ycoord", "coordy", "ycoordinate", "pointy", "lat",
    "latitude", "latitud", "hochwert", "nordwert", "ykoordinate", "yl93", "ylambert93", "ylambert", "coordonneey", "norte",
    "utmnorte", "coordenaday", "nordkoordinat", "pohjoiskoordinaatti", NULL};
const char *const wd_inventory_place_pairs[][2] = {{"e", "n"},   {"ost", "nord"},      {"est", "nord"},
                                                   {"osten", "norden"}, {"ita", "pohjoinen"}, {NULL, NULL}};
static const char *const species_names[] = {
    "species", "sp", "spp", "speciesname", "taxon", "scientificname", "latin", "latinname", "treespecies", "baumart",
    "speciescode", "treespeciescode", "spcode", "spcd", "taxonname", "binomial", "holzart", "art", "artname",
    "wissenschaftlichername", "lateinischername", "essence", "espece", "codeessence", "codeespece", "nomlatin",
    "nomscientifique", "especie", "codigoespecie", "nombrecientifico", "tradslag", "tradart", "puulaji", NULL};
static const char *const dbh_names[] = {
    "dbh", "d", "bhd", "d130", "d1.3", "diam", "diameter", "stemdiameter", "diameteratbreastheight", "trunkdiameter",
    "stemdiam", "durchmesser", "brusthohendurchmesser", "brusthoehendurchmesser", "diametre", "diam130", "diametre130",
    "dhp", "dap", "diametro", "diametronormal", "brosthojdsdiameter", "rinnankorkeuslapimitta", "lapimitta", NULL};
static const char *const height_names[] = {
    "height", "h", "ht", "totalheight", "treeheight", "hoehe", "hohe", "hauteur", "heighttotal", "totht", "httot", "hgt",
    "baumhohe", "baumhoehe", "hauteurtotale", "haut", "htot", "altura", "alturatotal", "hojd", "tradhojd", "pituus", NULL};
static const char *const crown_names[] = {
    "crowndiameter", "crown", "crownwidth", "crownd", "crowndiam", "kronendurchmesser", "kronenbreite",
    "diametrehouppier", "diametreduhouppier", "diametrocopa", "diametrodecopa", "krondiameter", "kronbredd", NULL};
/* Of trees alone: a number may as well be a plot's or a row's. */
static const char *const id_names[] = {
    "stemid", "treeid", "treetag", "tag", "treeno", "treenr", "treenumber", "id", "baumnr", "baumnummer", "baumid", "narbre",
    "noarbre", "numarbre", "numeroarbre", "idarbre", "narbol", "noarbol", "numarbol", "numeroarbol", "idarbol", "tradnr",
    "tradid", "puunro", "puunumero", NULL};
static const char *const status_names[] = {
    "status", "state", "condition", "treestatus", "statuscode", "statuscd", "dfstatus", "livedead", "alivedead", "zustand",
    "baumzustand", "lebendtot", "etat", "etatsanitaire", "vivantmort", "estado", "tillstand", NULL};
static const char *const plot_names[] = {
    "plot", "plotid", "plotno", "plotnr", "plotname", "quadrat", "parzelle", "probekreis", "placette", "parcelle", "parcela",
    "provyta", "koeala", NULL};
static const char *const azimuth_names[] = {"azimuth", "azimut", "azi", "bearing", "acimut", "riktning", "atsimuutti",
                                            "suunta", NULL};
static const char *const distance_names[] = {"distance", "dist", "distanz", "entfernung", "abstand", "distancia", "avstand",
                                             "etaisyys", NULL};
static const char *const girth_names[] = {"girth", "gbh", "circumference", "cbh", "umfang", "stammumfang", "circonference",
                                          "circ", "c130", "circunferencia", "cap", "omkrets", NULL};

static const struct wd_column_unit no_units[] = {{NULL, 0.0}};
static const struct wd_column_unit place_units[] = {{"m", 1.0},  {"cm", 0.0}, {"dm", 0.0}, {"km", 0.0},
                                                   {"ft", 0.0}, {"feet", 0.0}, {NULL, 0.0}};
static const struct wd_column_unit dbh_units[] = {
    {"cm", 1.0},    {"mm", 0.1},      {"dm", 10.0},  {"m", 100.0},    {"in", 2.54}, {"ft", 30.48}, {"inch", 2.54},
    {"inches", 2.54}, {"zoll", 2.54}, {"feet", 30.48}, {"yd", 0.0}, {"yards", 0.0}, {NULL, 0.0}};
static const struct wd_column_unit height_units[] = {
    {"m", 1.0},       {"dm", 0.1},     {"cm", 0.01},      {"mm", 0.001}, {"ft", 0.3048}, {"in", 0.0254}, {"feet", 0.3048},
    {"metres", 1.0},  {"meters", 1.0}, {"inches", 0.0254}, {"yd", 0.0},  {"yards", 0.0}, {NULL, 0.0}};

static const struct {
    const char *const *names;
    const struct wd_column_unit *units;
} columns[WD_INVENTORY_COLUMNS] = {
    [WD_COLUMN_X] = {x_names, place_units},
    [WD_COLUMN_Y] = {y_names, place_units},
    [WD_COLUMN_SPECIES] = {species_names, no_units},
    [WD_COLUMN_DBH] = {dbh_names, dbh_units},
    [WD_COLUMN_HEIGHT] = {height_names, height_units},
    [WD_COLUMN_CROWN] = {crown_names, height_units},
    [WD_COLUMN_ID] = {id_names, no_units},
    [WD_COLUMN_STATUS] = {status_names, no_units},
    [WD_COLUMN_PLOT] = {plot_names, no_units},
    [WD_COLUMN_AZIMUTH] = {azimuth_names, no_units},
    [WD_COLUMN_DISTANCE] = {distance_names, place_units},
    [WD_COLUMN_GIRTH] = {girth_names, dbh_units},
};

const char *const *wd_inventory_usual_names(enum wd_inventory_column column)
{
    return columns[column].names;
}

const struct wd_column_unit *wd_inventory_units(enum wd_inventory_column column)
{
    return columns[column].units;
}

static bool is_gap(char letter)
{
    return letter != 0 && strchr(" \t_.-/()[]", letter) != NULL;
}

/* In "DBH at 1.3 m" the number says that the place is meant. */
const struct wd_column_unit *wd_inventory_unit_of(const char *name, enum wd_inventory_column column, size_t *length)
{
    size_t end = strlen(name);
    while (end > 0 && is_gap(name[end - 1]))
        end--;
    size_t first = end;
    while (first > 0 && !is_gap(name[first - 1]))
        first--;
    *length = end;
    bool place = first > 1 && strchr(" .", name[first - 1]) && isdigit((unsigned char)name[first - 2]);
    for (const struct wd_column_unit *unit = columns[column].units; unit->name && first > 0 && !place; unit++)
        if (strlen(unit->name) == end - first && strncasecmp(unit->name, name + first, end - first) == 0) {
            *length = first;
            return unit;
        }
    return NULL;
}

char *wd_inventory_bracketed(const char *name)
{
    size_t end = strlen(name);
    if (end == 0 || !strchr(")]", name[end - 1]))
        return NULL;
    size_t first = end - 1;
    while (first > 0 && !strchr("([", name[first - 1]))
        first--;
    size_t length = end - 1 - first;
    bool place = strcspn(name + first, "0123456789") < length;
    return first > 0 && !place ? wd_format("%.*s", (int)length, name + first) : NULL;
}

/* Small letters without accents, and nothing between the words: "Tree ID", tree_id and treeID are one name. A point between
 * digits stays, or D_13, of 2013, would be D1.3. */
static void plain(char *to, size_t room, const char *name, size_t length)
{
    wd_utf8_plain(to, room, name, length);
    char *end = to;
    for (const char *at = to; *at; at++) {
        bool sign = strncmp(at, "\302\260", 2) == 0 || strncmp(at, "\302\272", 2) == 0; /* of a number */
        bool decimal = is_gap(*at) && at > to && isdigit((unsigned char)at[-1]) && isdigit((unsigned char)at[1]);
        if (decimal || (!is_gap(*at) && !sign))
            *end++ = decimal ? '.' : *at;
        at += sign;
    }
    *end = 0;
}

bool wd_inventory_has_name(const char *name, const char *usual, enum wd_inventory_column column,
                           const struct wd_column_unit **unit)
{
    char text[64];
    size_t length;
    *unit = wd_inventory_unit_of(name, column, &length);
    plain(text, sizeof text, name, length);
    return strcmp(text, usual) == 0;
}

bool wd_inventory_begins_as(const char *name, enum wd_inventory_column column)
{
    char text[64];
    plain(text, sizeof text, name, strlen(name));
    for (const char *const *usual = columns[column].names; *usual; usual++)
        if (strlen(*usual) > 1 && strncmp(text, *usual, strlen(*usual)) == 0)
            return true;
    return false;
}

int wd_inventory_find_usual(const struct wd_csv *csv, enum wd_inventory_column column)
{
    const struct wd_column_unit *unit;
    for (const char *const *usual = columns[column].names; *usual; usual++)
        for (size_t i = 0; i < csv->column_count; i++)
            if (wd_inventory_has_name(csv->header[i], *usual, column, &unit))
                return (int)i;
    return -1;
}

char *wd_inventory_list_units(enum wd_inventory_column column)
{
    char *list = wd_strdup("");
    for (const struct wd_column_unit *unit = columns[column].units; unit->name; unit++) {
        if (unit->factor == 0.0 || strlen(unit->name) > 2)
            continue;
        char *longer = wd_format("%s%s%s", list, *list ? ", " : "", unit->name);
        free(list);
        list = longer;
    }
    return list;
}
