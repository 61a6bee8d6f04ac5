#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tells a vehicle of what a detector has seen (docs/detections.md).

    detector.py /run/skein/detections-3.sock fire 59.1234 17.2345 --confidence 0.8 --name thermal

A detector of your own does the same for each incident that it sees: one JSON object, one datagram.
"""
import argparse
import json
import socket

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("socket", help="detections.socket of the vehicle's configuration")
parser.add_argument("kind", choices=["fire", "smoke", "flood", "spill", "landslide", "damage"])
parser.add_argument("latitude_deg", type=float)
parser.add_argument("longitude_deg", type=float)
parser.add_argument("--confidence", type=float, default=1.0, help="from 0 to 1")
parser.add_argument("--name", default="example", help="of the detector, for the operator")
arguments = parser.parse_args()

text = json.dumps({"kind": arguments.kind, "latitude_deg": arguments.latitude_deg,
                   "longitude_deg": arguments.longitude_deg, "confidence": arguments.confidence,
                   "detector": arguments.name})
with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as to_vehicle:
    to_vehicle.sendto(text.encode(), arguments.socket)
