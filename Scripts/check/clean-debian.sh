# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
#
# For scripts that check something in a clean minimal Debian; to be sourced, as root. Defines make_base, make_root,
# run_inside, inside and quietly, and the folder $work, which goes with the script.

# Mounts of its own, which end with the script.
[[ ${CLEAN_DEBIAN_MOUNTS:-} ]] || CLEAN_DEBIAN_MOUNTS=1 exec unshare --mount --fork "$0" ${arguments+"${arguments[@]}"}

work=$(mktemp -d)
# Everything that is mounted in there is let go before the folder is removed, or what is mounted would be removed.
clean_up()
{
  awk -v work="$work/" 'index($2, work) == 1 { print $2 }' /proc/mounts | sort -r | xargs -r umount -l
  if grep -q " $work/" /proc/mounts; then
    echo "$0: $work is left, as something is still mounted in it" >&2
    return
  fi
  rm -rf --one-file-system "$work"
}
trap clean_up EXIT

# The place of Debian's packages that this machine takes them from.
debian_archive()
{
  awk '/^URIs:/ { print $2; exit } /^deb / { for (i = 2; i <= NF; ++i) if ($i ~ /^http/) { print $i; exit } }' \
    /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list 2>/dev/null || true
}
make_base() # SUITE [PACKAGE,...]
{
  # A snapshot of the archive may be older than its files say they are good for. Without a place it is mmdebstrap's own.
  mmdebstrap --quiet --variant=minbase --include="ca-certificates${2:+,$2}" \
    --aptopt='Acquire::Check-Valid-Until "false"' "$1" "$work/base.tar" $(debian_archive)
}
make_root() # NAME: a clean system, which `inside` uses from here on
{
  root=$work/$1
  mkdir "$root"
  tar -x -f "$work/base.tar" -C "$root"
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  mount -t proc proc "$root/proc"
  mount --rbind /dev "$root/dev"
  mount --rbind /sys "$root/sys"
  echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/fast" # it is thrown away: no need to wait for the disk
}
run_inside() { chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
  DEBIAN_FRONTEND=noninteractive bash -o pipefail -c "cd /root && $1"; }
inside() { echo "# $1"; run_inside "$1"; }
quietly() { echo "# $*"; run_inside "$*" >"$work/log" 2>&1 || { tail -40 "$work/log" >&2; return 1; }; }
