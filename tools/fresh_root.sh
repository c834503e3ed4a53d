# Bare Debian 12 roots for tools that prove something where nothing was installed by hand. Sourced after common.sh.
# Needs root: debootstrap, chroot, and a mount namespace that ends with the command that it was made for.

fresh=${KADR_FRESH:-$project/build/fresh}

# need_root: checks the requirements of the functions below
need_root() {
  [[ $(id -u) -eq 0 ]] || fail "a bare root is made with debootstrap and chroot: run this as root"
  tools/setup fresh
}

# base_root: makes $fresh/base, debootstrap's minbase and no more, from the machine's own Debian sources; kept for a day
base_root() {
  local base=$fresh/base mirror line
  # a stale base would only cost time: its packages are upgraded where they are installed
  if [[ -f $base.done && -n $(find "$base.done" -mmin -1440) ]]; then return 0; fi
  rm -rf "$base" "$base.done"
  mkdir -p "$fresh"
  line='$(REPO_URI) $(CODENAME) $(COMPONENT)'
  mirror=$(apt-get indextargets --format "$line" 'Created-By: Packages' 'Origin: Debian' |
    sed -nE 's/^(\S+) bookworm main$/\1/p' | head -n 1)
  [[ -n $mirror ]] || fail "no source of Debian 12 (bookworm main) among this machine's; apt-get update may help"
  say "debootstrap"
  timed "debootstrap" debootstrap --variant=minbase bookworm "$base" "$mirror" >"$base.log" 2>&1 ||
    { tail -n 20 "$base.log" >&2; fail "debootstrap failed, see $base.log"; }
  # security updates and the like come from where the machine takes them; other origins stay out
  apt-get indextargets --format 'deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $(REPO_URI) $(CODENAME) $(COMPONENT)' \
    'Created-By: Packages' 'Origin: Debian' | grep ' bookworm' | sort -u >"$base/etc/apt/sources.list"
  # how this machine reaches its package registries
  apt-config dump | grep -E '^Acquire::(http|https|Check|Retries)' >"$base/etc/apt/apt.conf.d/90machine" || true
  for line in /etc/resolv.conf /etc/hosts /etc/npmrc; do
    [[ -e $line ]] && cp --parents -L "$line" "$base"
  done
  [[ ! -e $HOME/.npmrc ]] || cp "$HOME/.npmrc" "$base/root/.npmrc"
  # and the certificates it trusts there: the package ca-certificates would overwrite its own file
  if [[ -e /etc/ssl/certs/ca-certificates.crt ]]; then
    cp /etc/ssl/certs/ca-certificates.crt "$base/etc/machine-certificates.crt"
    sed -i 's|^cafile *=.*|cafile=/etc/machine-certificates.crt|' "$base/etc/npmrc" "$base/root/.npmrc" 2>/dev/null || true
  fi
  # the root is thrown away: no need to wait for the disk after each file
  echo force-unsafe-io >"$base/etc/dpkg/dpkg.cfg.d/90throwaway"
  touch "$base.done"
}

# make_root NAME [LOWER]: a root $fresh/NAME whose files are those of LOWER (default: the base) until it changes them
make_root() {
  local name=$1 lower=${2:-base}
  rm -rf "${fresh:?}/$name" "$fresh/$name.work" "$fresh/$name.lower"
  mkdir -p "$fresh/$name" "$fresh/$name.work"
  echo "$lower" >"$fresh/$name.lower"
}

# layers_of NAME: the folders of a root, topmost first, as overlayfs wants them
layers_of() {
  local name=$1
  while [[ -f $fresh/$name.lower ]]; do
    name=$(<"$fresh/$name.lower")
    printf '%s%s' "$fresh" "/$name"
    [[ -f $fresh/$name.lower ]] && printf ':'
  done
}

# in_root NAME COMMAND...: runs a command in that root as root, in /root, with a clean environment. It sees proc, pseudo-terminals, shared
# memory, and in /fresh a folder of the disk below (an overlay can't carry another) for roots that it makes itself. All
# mounts and processes end with the command.
in_root() {
  local name=$1 at=$fresh/$1.at
  shift
  mkdir -p "$at" "$fresh/$name.disk"
  FRESH_LAYERS=$(layers_of "$name") FRESH_UPPER=$fresh/$name FRESH_WORK=$fresh/$name.work FRESH_DISK=$fresh/$name.disk FRESH_AT=$at \
    unshare --mount --pid --fork --kill-child --propagation private bash -c '
      set -eu
      mount -t overlay -o "lowerdir=$FRESH_LAYERS,upperdir=$FRESH_UPPER,workdir=$FRESH_WORK" overlay "$FRESH_AT"
      mount -t proc proc "$FRESH_AT/proc"
      mount -t devpts -o newinstance,ptmxmode=0666,mode=620,gid=5 devpts "$FRESH_AT/dev/pts"
      mount --bind "$FRESH_AT/dev/pts/ptmx" "$FRESH_AT/dev/ptmx"
      mount -t tmpfs -o mode=1777 tmpfs "$FRESH_AT/dev/shm"
      mkdir -p "$FRESH_AT/fresh"
      mount --bind "$FRESH_DISK" "$FRESH_AT/fresh"
      exec chroot "$FRESH_AT" /usr/bin/env -i HOME=/root USER=root LANG=C.UTF-8 TERM=dumb KADR_FRESH=/fresh \
        NODE_EXTRA_CA_CERTS=/etc/machine-certificates.crt ${CI:+CI=$CI} \
        PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin bash -c '\''cd && exec "$@"'\'' bash "$@"' \
      in_root "$@"
}

# clone_into NAME PLACE: the last commit of this tree (uncommitted changes stay out), at PLACE in that root
clone_into() {
  local name=$1 place=$2
  [[ -z $(git -C "$project" status --porcelain) ]] || say "uncommitted changes are not part of the clone"
  mkdir -p "$fresh/$name$(dirname "$place")"
  git clone --quiet --no-local --depth 1 "file://$project" "$fresh/$name$place"
}

# keep_times NAME PLACE: adds the times that tools took in that clone to this call's, as steps within the present one
keep_times() {
  local inside=$fresh/$1$2/build/times.tsv
  [[ ! -f $inside ]] || awk -F '\t' -v OFS='\t' -v depth="$KADR_STEP_DEPTH" '{ $3 += depth; print }' "$inside" >>"$times"
}

remove_root() { rm -rf "${fresh:?}/$1" "$fresh/$1".{work,lower,at,disk,log}; }
