/* parts.h: groups of tests that share test-api's suite. Each returns how many failed. */
#ifndef WD_TESTS_API_PARTS_H
#define WD_TESTS_API_PARTS_H

#include "suite.h"

int argument_tests(struct suite *suite);
int forest_tests(struct suite *suite);
int film_tests(struct suite *suite);
int memory_tests(struct suite *suite);

#endif
