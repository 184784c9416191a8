#include "cli.h"

#include <stdio.h>
#include <stdlib.h>

enum cli_status cli_devices(struct cli_session *session)
{
    char *devices = wd_device_list();
    bool found = devices && *devices;
    if (found)
        fputs(devices, stdout);
    else
        cli_fail(session, "no Vulkan device found; software Vulkan is in the package "
                          "mesa-vulkan-drivers");
    free(devices);
    return found ? CLI_OK : CLI_FAILED;
}
