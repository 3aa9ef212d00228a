# shellcheck shell=bash
# SPDX-License-Identifier: Apache-2.0
# Bare Debian roots for tests, to be sourced. All of it needs root.
#   debian_make SUITE ROOT    debootstraps SUITE (minbase) into the new folder ROOT, with this machine's package archive
#   debian_enter ROOT         mounts what programs inside need; the compiler's cache and the project's (kernel image,
#                             roots) are lent: they save time and change nothing
#   debian_inside ROOT COMMAND…   runs a shell command inside, in the folder that is called as this one, with a clean environment
#   debian_leave ROOT         ends what still runs inside and unmounts
coupler_cache=${COUPLER_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/coupler}
compiler_cache=${CCACHE_DIR:-$HOME/.cache/ccache}

debian_make() {
  local suite=$1 root=$2 part
  debootstrap --variant=minbase "$suite" "$root" >"$root.log" 2>&1 || { tail -n 20 "$root.log"; rm -f "$root.log"; return 1; }
  rm -f "$root.log"
  cp /etc/resolv.conf "$root/etc/"
  for part in sources.list sources.list.d/debian.sources apt.conf.d/99proxy; do
    [ ! -e "/etc/apt/$part" ] || sed "s/bookworm/$suite/g" "/etc/apt/$part" >"$root/etc/apt/$part"
  done
}

debian_enter() {
  local root=$1 lent
  mount -t proc proc "$root/proc"
  mount --rbind /dev "$root/dev"
  mount --make-rslave "$root/dev"
  mount -t sysfs -o ro sysfs "$root/sys"
  for lent in "$compiler_cache" "$coupler_cache"; do
    mkdir -p "$lent" "$root$lent"
    mount --bind "$lent" "$root$lent"
  done
}

debian_inside() {
  local root=$1
  shift
  env -i HOME="$HOME" TERM=dumb LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin \
    CCACHE_DIR="$compiler_cache" COUPLER_CACHE="$coupler_cache" chroot "$root" bash -c "cd '$PWD' && $*"
}

debian_leave() {
  local root=$1 process mounted
  for process in $(find /proc -maxdepth 2 -name root -lname "$root*" 2>/dev/null | cut -d/ -f3); do
    kill "$process" 2>/dev/null || true
  done
  for mounted in $(awk -v root="$root/" 'index($2, root) == 1 {print $2}' /proc/mounts | sort -r); do
    umount --lazy "$mounted" 2>/dev/null || true # one mount can be listed twice
  done
}
