#!/bin/sh
# Sourced: installs $build below $scratch, and says how a program is compiled against it and run.
# $flags: of weald; $libraries: where the program finds them.
# shellcheck disable=SC2034,SC2154  # whoever sources it sets the ones and reads the others
DESTDIR=$scratch/installed meson install -C "$build" --no-rebuild --quiet
pc=$(find "$scratch/installed" -name weald.pc)
[ -n "$pc" ]
PKG_CONFIG_SYSROOT_DIR=$scratch/installed
PKG_CONFIG_PATH=$(dirname "$pc")
export PKG_CONFIG_SYSROOT_DIR PKG_CONFIG_PATH
# A system root is put before every directory, also before Vulkan's: only weald's flags are asked for.
flags=$(pkg-config --cflags --libs weald | sed "s,$scratch/installed/usr/include ,/usr/include ,g")
libraries=$(dirname "$(find "$scratch/installed" -name 'libweald.so' | head -1)")
