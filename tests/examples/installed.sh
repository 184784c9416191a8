#!/bin/sh
# Sourced: installs $build below $scratch, and says how a program is compiled against it and run.
# $flags: of weald; $libraries: where the program finds them.
# shellcheck disable=SC2034,SC2154  # whoever sources it sets the ones and reads the others
DESTDIR=$scratch/installed meson install -C "$build" --no-rebuild --quiet
pc=$(find "$scratch/installed" -name weald.pc)
[ -n "$pc" ]
PKG_CONFIG_PATH=$(dirname "$pc")
export PKG_CONFIG_PATH
program=$(find "$scratch/installed" -path '*/bin/weald')
flags=$(pkg-config --define-variable=prefix="${program%/bin/weald}" --cflags --libs weald)
libraries=$(dirname "$(find "$scratch/installed" -name 'libweald.so' | head -1)")
# Whoever compiles against it needs none of the packages that it is made with, but Vulkan's.
[ "$(pkg-config --print-requires weald)" = vulkan ]
[ -z "$(pkg-config --print-requires-private weald)" ]
# The program finds the library beside itself, but in the system's own prefix, where a loader finds it.
if [ "$program" != "$scratch/installed/usr/bin/weald" ]; then
    mv "$scratch/installed" "$scratch/moved"
    env -u LD_LIBRARY_PATH "$scratch/moved${program#"$scratch/installed"}" --version
    mv "$scratch/moved" "$scratch/installed"
fi
