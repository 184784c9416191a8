/* Asks a window to close as a window manager's close button does: close_window ID. */
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
    Display *display = XOpenDisplay(NULL);
    if (!display || argc != 2)
        return 1;
    XEvent event = {.xclient = {
                        .type = ClientMessage,
                        .window = strtoul(argv[1], NULL, 0),
                        .message_type = XInternAtom(display, "WM_PROTOCOLS", False),
                        .format = 32,
                    }};
    event.xclient.data.l[0] = (long)XInternAtom(display, "WM_DELETE_WINDOW", False);
    event.xclient.data.l[1] = CurrentTime;
    XSendEvent(display, event.xclient.window, False, NoEventMask, &event);
    XSync(display, False);
    XCloseDisplay(display);
    return 0;
}
