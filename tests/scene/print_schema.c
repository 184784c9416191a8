/* Prints a published schema: `scene-print-schema scene > docs/scene.schema.json`. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "schemas.h"

int main(int argc, char **argv)
{
    for (size_t i = 0; argc == 2 && i < SCHEMA_COUNT; i++) {
        if (strcmp(argv[1], schemas[i].name) != 0)
            continue;
        char *text = wd_keys_schema(schemas[i].table, schemas[i].name);
        puts(text);
        free(text);
        return 0;
    }
    fputs("usage: scene-print-schema scene|species|model\n", stderr);
    return 1;
}
