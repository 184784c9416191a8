/* inventory_messages_test.c: files as people have them, in several languages and units, and what is said of them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/memory.h"
#include "inventory_file.h"

static const char *const path = "inventory_messages_test.csv";

static void assert_not_said(const char *text, const char *part)
{
    if (strstr(text, part))
        fail_msg("\"%s\" is in \"%s\"", part, text);
}

static void fail_to_make(struct small_scene *small, const char *text, const char *part)
{
    struct wd_world world;
    write_file(path, text);
    assert_false(make(small, &world));
    assert_said(captured.errors, part);
}

/* The tree of the file, which has one. */
static struct wd_tree only_tree(struct small_scene *small, const char *text)
{
    struct wd_world world;
    write_file(path, text);
    make_or_fail(small, &world);
    assert_int_equal(world.tree_count, 1);
    struct wd_tree tree = world.trees[0];
    wd_world_finish(&world);
    return tree;
}

/* A spruce 10 m east and 20 m north, 40 cm thick and 12 m high. */
static void test_languages(void **state)
{
    (void)state;
    static const char *const headers[] = {
        "Este,Norte,Especie,DAP,Altura",
        "Este,Norte,Especie,DAP (cm),Altura total (m)",
        "\303\226st,Nord,Tr\303\244dslag,Diameter,H\303\266jd",
        "E,N,Tr\303\244dslag,DBH,H\303\226JD",
        "X_L93,Y_L93,Essence,Diam\303\250tre,Hauteur totale (m)",
        "Est,Nord,Esp\303\250ce,Diam. (cm),Haut",
        "Rechtswert,Hochwert,Art,Durchmesser [cm],Baumho\314\210he",
        "X,Y,Tree species code,DBH,Tree\302\240Height (m)",
        "It\303\244,Pohjoinen,Puulaji,L\303\244pimitta,Pituus",
        "XCoord,y coord,TreeSpecies,d1.3,H.m",
    };
    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++) {
        struct small_scene small;
        small_scene_init(&small);
        small_scene_inventory(&small, path);
        char *text = wd_format("%s\n10,20,Picea abies,40,12\n", headers[i]);
        struct wd_tree tree = only_tree(&small, text);
        free(text);
        assert_int_equal(tree.x_mm, 10000);
        assert_int_equal(tree.y_mm, 20000);
        assert_int_equal(WD_TREE_SPECIES(tree), 1);
        assert_int_equal(tree.size & 0xffff, 1200);
        double crown_m = wd_species_crown_m(&small.species[1], 40.0);
        assert_true(fabs((tree.size >> 16) - crown_m * 100.0) < 1.0);
        assert_not_said(captured.others, "recognised");
    }
}

/* Letters that may be anything: E is a place where N is one, and x is better. */
static void test_no_wrong_guesses(void **state)
{
    (void)state;
    struct small_scene small;
    small_scene_init(&small);
    small_scene_inventory(&small, path);
    fail_to_make(&small, "E,dbh\n10,30\n", "no column for x was recognised");
    fail_to_make(&small, "N,E2\n10,30\n", "no column for x was recognised");
    struct wd_tree tree = only_tree(&small, "E,N,x,y\n1,2,30,40\n");
    assert_int_equal(tree.x_mm, 30000);
    assert_int_equal(tree.y_mm, 40000);
    tree = only_tree(&small, "x,y,D_13\n10,20,40\n"); /* of 2013 */
    assert_int_equal(tree.size, only_tree(&small, "x,y\n10,20\n").size);
    tree = only_tree(&small, "x,y,D1.3\n10,20,40\n");
    assert_int_not_equal(tree.size, only_tree(&small, "x,y\n10,20\n").size);
    fail_to_make(&small, "plot,Azimut,Distanz,BHD\n1,10,5,30\n",
                 "columns Azimut and Distanz tell places from a plot's middle, but x and y are wanted: convert them");
}

static void test_mapping_without_column(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_string_pair names[] = {{"Picea abies", "spruce"}, {"*", "birch"}};
    small_scene_init(&small);
    struct wd_scene_inventory *inventory = small_scene_inventory(&small, path);
    inventory->species = names;
    inventory->species_count = 2;
    fail_to_make(&small, "x,y,Kind\n1,1,Picea abies\n", "inventory_messages_test.csv:1: no column for the species was "
                 "recognised, so \"species\" cannot tell the trees apart; name it in \"columns\": {\"species\": \"...\"}");
    assert_said(captured.errors, "the header has: x, y, Kind");
    inventory->species_count = 1;
    small.files[0].name = "spruce";
    small.scene.species_file_count = 1;
    assert_said(said_of(path, "x,y,height\n1,1,20\n", &small), "all trees are \"spruce\"; the header has: x, y, height");
    inventory->species = (struct wd_string_pair[]){{"*", "spruce"}};
    assert_said(said_of(path, "x,y,Kind\n1,1,Picea abies\n", &small),
                "so all trees are of one; if Kind has it, say so: \"columns\": {\"species\": \"Kind\"}");
    assert_not_said(said_of(path, "x,y,height,date\n1,1,20,2020-05-01\n", &small), "species");
}

static void test_mapped_for_nothing(void **state)
{
    (void)state;
    struct small_scene small;
    struct wd_string_pair names[] = {{"Fi", "spruce"}, {"Ei", "oak"}, {"Bu", "oak"}, {"*", "birch"}};
    small_scene_init(&small);
    struct wd_scene_inventory *inventory = small_scene_inventory(&small, path);
    inventory->species = names;
    inventory->species_count = 4;
    assert_said(said_of(path, "x,y,Art\n1,1,FI\n2,2,?\n", &small),
                "no living tree is called \"Ei\", \"Bu\" in column Art, as \"species\" says");
    assert_not_said(said_of(path, "x,y,Art\n1,1,Fi\n2,2,Ei\n3,3,bu\n", &small), "no living tree");
}

/* Names as botanists and tables have them. */
static void test_names_of_species(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        uint32_t species;
    } rows[] = {{"Picea abies (L.) H.Karst.", 1}, {"Picea_abies", 1},      {"PICEA  ABIES", 1},
                {"Picea\302\240abies", 1},          {"Picea abies L.", 1}, {"Fichte (Rot-)", 1},
                {"r\303\226tfichte", 1},            {"Picea abies var. obovata", 2}, {"Picea", 2},
                {"Picea abiesoides", 2},            {"spruces", 2}};
    struct small_scene small;
    struct wd_string_pair names[] = {{"fichte  (rot-)", "spruce"}, {"R\303\266tfichte", "spruce"}, {"*", "birch"}};
    small_scene_init(&small);
    struct wd_scene_inventory *inventory = small_scene_inventory(&small, path);
    inventory->species = names;
    inventory->species_count = 3;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char *text = wd_format("x,y,species\n1,1,%s\n", rows[i].name);
        struct wd_tree tree = only_tree(&small, text);
        free(text);
        if (WD_TREE_SPECIES(tree) != rows[i].species)
            fail_msg("%s is species %u", rows[i].name, WD_TREE_SPECIES(tree));
    }
}

static void test_dead_that_live(void **state)
{
    (void)state;
    static const char *dead[] = {"tot"};
    struct small_scene small;
    small_scene_init(&small);
    struct wd_scene_inventory *inventory = small_scene_inventory(&small, path);
    const char *said = said_of(path, "x,y,status\n1,1,tot\n2,2,Muerto en pie\n3,3,alive\n4,4,D\n5,5,tot\n6,6,dead\n", &small);
    assert_said(said, "column status: \"tot\" (2), \"Muerto en pie\" (1), \"D\" (1) counted as living; to leave these out, "
                      "say \"dead\": [\"dead\", \"tot\", \"Muerto en pie\", \"D\"]");
    assert_not_said(said_of(path, "x,y,status\n1,1,A\n2,2,dead\n3,3,dead top\n", &small), "living");
    inventory->dead = dead;
    inventory->dead_count = 1;
    assert_not_said(said_of(path, "x,y,Zustand\n1,1,tot\n2,2,lebend\n", &small), "status");
    assert_said(said_of(path, "x,y,Kommentar\n1,1,tot\n2,2,lebend\n", &small),
                "no column for the status was recognised, so no tree is left out as \"tot\"; name it in \"columns\": "
                "{\"status\": \"...\"}; the header has: x, y, Kommentar");
}

static void test_units(void **state)
{
    (void)state;
    struct small_scene small;
    small_scene_init(&small);
    struct wd_scene_inventory *inventory = small_scene_inventory(&small, path);
    struct wd_tree tree = only_tree(&small, "x,y,DBH [dm],H [dm]\n1,1,4,95\n");
    assert_int_equal(tree.size & 0xffff, 950);
    double crown_m = wd_species_crown_m(&small.species[0], 40.0);
    assert_true(fabs((tree.size >> 16) - crown_m * 100.0) < 1.0);
    fail_to_make(&small, "x,y,Height (yd)\n1,1,10\n", "inventory_messages_test.csv:1: column Height (yd): yd is no unit "
                 "that is read; known are m, dm, cm, mm, ft, in; convert the column, or say what it is in height_unit");
    fail_to_make(&small, "Easting (ft),y,H\n1,1,10\n", "column Easting (ft): ft is no unit that is read; known are m; convert");
    inventory->height_unit = "dm";
    assert_int_equal(only_tree(&small, "x,y,H\n1,1,95\n").size & 0xffff, 950);
    inventory->height_unit = NULL;
    inventory->columns.height = "H [rod]";
    assert_said(said_of(path, "x,y,H [rod]\n1,1,3\n", &small), "column H [rod]: \"rod\" is no unit that is known (m, dm, cm, "
                "mm, ft, in), so it counts as m; say what it is in height_unit");
    inventory->height_unit = "ft";
    assert_not_said(said_of(path, "x,y,H [rod]\n1,1,3\n", &small), "unit");
    inventory->columns.height = "H (in 2020)";
    inventory->height_unit = NULL;
    assert_not_said(said_of(path, "x,y,H (in 2020)\n1,1,3\n", &small), "unit");
    inventory->columns.height = NULL;
    assert_said(said_of(path, "x,y,Height (est.)\n1,1,3\n", &small), "if Height (est.) is, say so");
}

/* Units that nothing tells of. */
static void test_units_by_size(void **state)
{
    (void)state;
    struct small_scene small;
    small_scene_init(&small);
    small_scene_inventory(&small, path);
    assert_said(said_of(path, "x,y,dbh,height\n1,1,13,75\n2,5,18,90\n3,3,10,60\n", &small),
                "it would be a usual tree with \"height_unit\": \"ft\" and \"dbh_unit\": \"in\"");
    assert_not_said(captured.others, "\"mm\"");
    assert_said(said_of(path, "x,y,dbh,height\n1,1,120,95\n2,5,130,100\n", &small),
                "\"height_unit\": \"dm\" and \"dbh_unit\": \"mm\"");
    assert_said(said_of(path, "x,y,height\n1,1,75\n2,5,90\n", &small),
                "would be 90 m high, 2.2 times the species' greatest height; it would be a usual tree with "
                "\"height_unit\": \"ft\"");
    assert_said(said_of(path, "x,y,dbh (cm),height\n1,1,30,80\n2,5,30,90\n", &small), "\"height_unit\": \"ft\"");
    assert_not_said(captured.others, "dbh_unit");
    assert_not_said(said_of(path, "x,y,dbh,height\n1,1,1.2,2.4\n2,5,1,2.9\n", &small), "middle one"); /* saplings */
    assert_not_said(said_of(path, "x,y,dbh,height\n1,1,25,39\n2,5,22,41\n", &small), "middle one");
    assert_not_said(said_of(path, "x,y,dbh (cm),height (m)\n1,1,13,75\n2,5,18,90\n", &small), "middle one");
}

static void test_girth(void **state)
{
    (void)state;
    struct small_scene small;
    small_scene_init(&small);
    struct wd_scene_inventory *inventory = small_scene_inventory(&small, path);
    assert_said(said_of(path, "x,y,Umfang [cm],H\n1,1,94,20\n", &small), "Umfang [cm] reads as a girth, which is not read");
    assert_not_said(said_of(path, "x,y,girth,dbh\n1,1,94,30\n", &small), "girth");
    inventory->columns.dbh = "Circonf\303\251rence";
    assert_said(said_of(path, "x,y,Circonf\303\251rence\n1,1,94\n", &small), "reads as a girth, but counts as a diameter");
}

static void test_plots_on_one_another(void **state)
{
    (void)state;
    struct small_scene small;
    small_scene_init(&small);
    small_scene_inventory(&small, path);
    assert_said(said_of(path, "Plot,x,y\n1,1,1\n1,19,18\n2,2,1\n2,18,19\n", &small),
                "Plot 1 and 2 lie on one another; if x and y count from each plot's own corner");
    assert_not_said(said_of(path, "Plot,x,y\n1,1,1\n1,19,18\n2,15,1\n2,38,19\n", &small), "one another");
}

static int remove_file(void **state)
{
    (void)state;
    unlink(path);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_languages),
        cmocka_unit_test(test_no_wrong_guesses),
        cmocka_unit_test(test_mapping_without_column),
        cmocka_unit_test(test_mapped_for_nothing),
        cmocka_unit_test(test_names_of_species),
        cmocka_unit_test(test_dead_that_live),
        cmocka_unit_test(test_units),
        cmocka_unit_test(test_units_by_size),
        cmocka_unit_test(test_girth),
        cmocka_unit_test(test_plots_on_one_another),
    };
    return cmocka_run_group_tests_name("inventory messages", tests, NULL, remove_file);
}
