# shellcheck shell=bash
# SPDX-License-Identifier: Apache-2.0
# Bare Debian roots for tests, to be sourced by a script that is in $self, with its arguments. All of it needs root.
#   debian_unpack ROOT SUITE [PACKAGE…]   makes the new folder ROOT: SUITE (minbase) and the packages, this machine's archive
#   debian_enter ROOT         mounts what programs inside need; the compiler's cache and the project's (kernel image,
#                             roots) are lent, and packages that were downloaded before: they save time and change nothing
#   debian_inside ROOT COMMAND…   runs a shell command inside, in the folder that is called as this one, with a clean environment
#   debian_leave ROOT         ends what still runs inside, keeps what was downloaded and unmounts
#   debian_remove ROOT…       leaves and deletes them
# A root is debootstrapped once and kept in ~/.cache/coupler/roots (COUPLER_CACHE names another cache), under a name that
# changes with its recipe. What is unpacked from there is in build/.roots: hidden, for roslaunch searches this tree.
coupler_cache=${COUPLER_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/coupler}
compiler_cache=${CCACHE_DIR:-$HOME/.cache/ccache}

# The script goes on in mounts of its own. They end with its last process, even if it is killed, and from outside the
# roots are bare folders: who deletes one there cannot delete what is lent to it.
if [ -z "${outside_mounts-}" ]; then
  exec {outside_mounts}</proc/self/ns/mnt
  export outside_mounts
  exec unshare --mount "${self:?}" "$@"
fi
outside() { nsenter --mount="/proc/self/fd/$outside_mounts" "$@"; }

debian_roots=$PWD/build/.roots
mkdir -p "$debian_roots"
unset TMPDIR # no folder of the roots
trap 'exit 130' INT
trap 'exit 143' TERM HUP

debian_make() {
  local root=$1 suite=$2
  shift 2
  {
    if [ $# -eq 0 ]; then
      debootstrap --variant=minbase "$suite" "$root" && debian_sources "$root" "$suite" && chroot "$root" apt-get -q update
    else
      debian_unpack "$root" "$suite" && debian_enter "$root" &&
        chroot "$root" bash -c "apt-get -q update && DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $*"
    fi
  } >"$root.log" 2>&1 || { tail -n 25 "$root.log"; return 1; }
  debian_leave "$root"
  rm -f "$root"/var/cache/apt/archives/*.deb
}

debian_sources() {
  local root=$1 suite=$2 part
  cp /etc/resolv.conf "$root/etc/"
  for part in sources.list sources.list.d/debian.sources apt.conf.d/99proxy; do
    [ ! -e "/etc/apt/$part" ] || sed "s/bookworm/$suite/g" "/etc/apt/$part" >"$root/etc/apt/$part"
  done
}

# Prints the root's file. One at a time makes it; who was killed has left another name.
debian_file() {
  local suite=$1 file new lock status=0
  file=$coupler_cache/roots/$suite-$({ printf '%s\n' "$@"; declare -f debian_make; } | sha256sum | cut -c 1-16).tar
  mkdir -p "${file%/*}"
  exec {lock}>"$file.lock"
  flock "$lock"
  if [ ! -e "$file" ]; then
    echo "making $file: $*" >&2
    find "${file%/*}" -maxdepth 1 -name '*.tar*' -mtime +30 -delete
    new=$debian_roots/$(basename "$file" .tar)
    debian_remove "$new"
    debian_make "$new" "$@" >&2 && outside tar -C "$new" -cf "$file.new" . && mv "$file.new" "$file" || status=1
    debian_remove "$new"
  fi
  exec {lock}>&-
  touch -c "$file"
  echo "$file"
  return "$status"
}

debian_unpack() {
  local root=$1 suite=$2 file
  file=$(debian_file "${@:2}") || return
  debian_remove "$root"
  mkdir "$root"
  tar -C "$root" -xf "$file" || { echo "delete $file to have it made again" >&2; return 1; }
  echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe-io" # nobody needs this root after a power failure
  debian_sources "$root" "$suite"
}

# The folder of a root's downloaded packages. It is copied, for apt locks its own.
debian_packages() { (. "$1/etc/os-release" && echo "$coupler_cache/apt/$VERSION_CODENAME"); }

debian_lend_packages() {
  local kept
  kept=$(debian_packages "$1")
  mkdir -p "$kept"
  find "$kept" -name '*.deb' -exec cp --link -t "$1/var/cache/apt/archives" {} + 2>/dev/null ||
    find "$kept" -name '*.deb' -exec cp -t "$1/var/cache/apt/archives" {} + || true
}

debian_keep_packages() {
  local kept package file
  kept=$(debian_packages "$1")
  for package in "$1"/var/cache/apt/archives/*.deb; do
    file=$kept/${package##*/}
    [ ! -e "$package" ] || [ -e "$file" ] || { cp "$package" "$file.$BASHPID" && mv "$file.$BASHPID" "$file"; }
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
  debian_lend_packages "$root"
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
  [ ! -e "$root/etc/os-release" ] || debian_keep_packages "$root"
  awk -v root="$root/" 'index($2, root) == 1 {print $2}' /proc/mounts | sort -r | while read -r mounted; do
    umount --lazy "$mounted" 2>/dev/null || true # one mount can be listed twice
  done
}

debian_remove() {
  local root
  for root in "$@"; do
    debian_leave "$root"
    outside rm -rf "$root" "$root.log"
  done
}
