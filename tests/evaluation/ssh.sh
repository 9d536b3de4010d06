#!/bin/bash
# Runs a command with an SSH server of its own on this machine's loopback, which takes one key that is made for it. ssh -F $TRAX_SSH_CONFIG
# knows it as "first" and "second". Nothing of the user's or the system's SSH is touched, and nothing is left behind.
#   tests/evaluation/ssh.sh COMMAND...
# Needs Debian's openssh-server and openssh-client. Exit status: the command's; 77 where they are missing.
set -u
PATH=$PATH:/usr/sbin
for program in sshd ssh ssh-keygen; do
  command -v $program >/dev/null || { echo "ssh.sh: $program is not installed (apt-get install openssh-server openssh-client)" >&2; exit 77; }
done
work=$(mktemp -d) || exit 1
server=
stop() {
  [ -n "$server" ] && kill "$server" 2>/dev/null && wait "$server" 2>/dev/null
  rm -rf "$work"
}
trap stop EXIT
trap 'exit 130' INT TERM

[ "$(id -u)" -eq 0 ] && mkdir -p /run/sshd # where the package's service would make it
ssh-keygen -q -t ed25519 -N '' -f "$work/host" && ssh-keygen -q -t ed25519 -N '' -f "$work/user" || exit 1
port=$((20000 + $$ % 20000))
cat >"$work/sshd_config" <<CONF
ListenAddress 127.0.0.1
Port $port
HostKey $work/host
PidFile $work/sshd.pid
AuthorizedKeysFile $work/user.pub
StrictModes no
PasswordAuthentication no
KbdInteractiveAuthentication no
PermitRootLogin prohibit-password
UsePAM no
MaxStartups 100
CONF
echo "[127.0.0.1]:$port $(cut -d ' ' -f 1,2 "$work/host.pub")" >"$work/known"
cat >"$work/ssh_config" <<CONF
Host first second
  HostName 127.0.0.1
  Port $port
  User $(id -un)
  IdentityFile $work/user
  IdentitiesOnly yes
  UserKnownHostsFile $work/known
  BatchMode yes
CONF
export TRAX_SSH_CONFIG=$work/ssh_config
"$(command -v sshd)" -D -e -f "$work/sshd_config" 2>"$work/out" &
server=$!
for _ in $(seq 50); do
  ssh -F "$TRAX_SSH_CONFIG" first true 2>"$work/refused" && ready=1 && break
  kill -0 $server 2>/dev/null || break
  sleep 0.1
done
if [ -z "${ready:-}" ]; then
  echo "ssh.sh: the server did not start:" >&2
  tail -n 5 "$work/refused" "$work/out" >&2
  exit 1
fi
"$@"
