#include "weald/types.h"

const char *wd_version(void)
{
    return WEALD_VERSION;
}
