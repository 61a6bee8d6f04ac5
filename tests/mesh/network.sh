#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# network.sh [--one-hop] NODES COMMAND [ARGUMENT...]
#   Makes machines of a mesh as network namespaces, 15 at most, and runs COMMAND beside them. Machine N is
#   skein<N>, with the address 10.54.0.N, machine 0 with 10.54.0.100, on br0, a bridge of two ports:
#     bat0    batman-adv as packaging/networkd sets it up. Its frames go from interface `radio` into the ether.
#     wire    to a bridge of the namespace where COMMAND is, 10.54.0.254: it hears all, and all hear it.
#   With --one-hop `radio` itself is the port, in place of bat0: only neighbours hear each other.
#   Ports between which nothing is to go are `isolated`: bat0 and wire, so that the wire is no way
#   around the mesh, and all of the wires, so that no machine hears another there.
#   The ether is a namespace, too, in which each machine has a port. What leaves by the port of machine TO
#   is queued by who sent it into the ether, FROM: band FROM + 1 of a prio, where a netem says how TO hears
#   FROM (links.sh). At first nobody hears anybody.
set -euo pipefail
export PATH=/usr/sbin:/usr/bin:/sbin:/bin

over=bat0
if [[ $1 == --one-hop ]]; then
  over=radio
  shift
fi
nodes=$1
shift
mount -t tmpfs tmpfs /run
mkdir /run/netns

address() { echo "10.54.0.$(($1 == 0 ? 100 : $1))/24"; }

{
  echo "link set lo up
    link add wires type bridge mcast_snooping 0
    address add 10.54.0.254/24 broadcast + dev wires
    link set wires up
    netns add ether"
  for ((i = 0; i < nodes; i++)); do
    echo "netns add skein$i
      link add wire$i master wires type veth peer name wire netns skein$i
      link set wire$i up"
  done
} | ip -batch -
for ((i = 0; i < nodes; i++)); do echo "link set dev wire$i isolated on"; done | bridge -batch -

{
  echo "link add ether mtu 1600 type bridge mcast_snooping 0
    link set ether up"
  for ((i = 0; i < nodes; i++)); do
    echo "link add radio$i mtu 1600 master ether type veth peer name radio netns skein$i
      link set radio$i up"
  done
} | ip -n ether -batch -
for ((to = 0; to < nodes; to++)); do
  echo "qdisc add dev radio$to root handle 1: prio bands 16 priomap 15 15 15 15 15 15 15 15 15 15 15 15 15 15 15 15
    qdisc add dev radio$to clsact"
  for ((from = 0; from < nodes; from++)); do
    ((from == to)) || printf 'qdisc add dev radio%d parent 1:%x netem loss 100%%\n' "$to" $((from + 1))
  done
  printf 'filter add dev radio%d ingress matchall action skbedit priority 1:%x\n' "$to" $((to + 1))
done | tc -n ether -batch -

for ((i = 0; i < nodes; i++)); do
  echo "link set lo up
    link set radio mtu 1532 up
    link add bat0 type batadv ra BATMAN_V
    link add br0 type bridge mcast_snooping 0
    link set wire master br0" | ip -n "skein$i" -batch -
  ip netns exec "skein$i" batctl meshif bat0 bridge_loop_avoidance 0
  ip netns exec "skein$i" batctl meshif bat0 hop_penalty 15
  [[ $over != bat0 ]] || ip -n "skein$i" link set radio master bat0
  ip -n "skein$i" link set "$over" master br0
  printf 'link set dev %s isolated on\n' "$over" wire | bridge -n "skein$i" -batch -
  echo "link set $over up
    link set wire up
    address add $(address "$i") broadcast + dev br0
    link set br0 up" | ip -n "skein$i" -batch -
done
# Not exec: as the first process of its pid namespace the command would have to reap what it inherits.
"$@"
