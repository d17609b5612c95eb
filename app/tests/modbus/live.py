"""Looks at an axis that runs, whatever it does, with pymodbus: what its map says must agree with itself.

usage: live.py serial|tcp ADDRESS UNIT PLACE LIST
PLACE is the first register of motion.counts_per_mm, LIST the checksum of the list of parameters. Where the axis is off the
parameter is written and put back; where it is on that must be refused.
"""

import sys
import time

from pymodbus import FramerType
from pymodbus.client import ModbusSerialClient, ModbusTcpClient

kind, address, unit, place, names = sys.argv[1:]
unit, place, names = int(unit), int(place), int(names)
# An emulated axis may be slow, or not be there yet: it is asked again.
if kind == "serial":
    line = ModbusSerialClient(address, framer=FramerType.RTU, baudrate=19200, timeout=5, retries=3)
else:
    host, port = address.rsplit(":", 1)
    line = ModbusTcpClient(host, port=int(port), framer=FramerType.RTU, timeout=5, retries=3)
assert line.connect(), f"no connection to {address}"
types = line.DATATYPE


def decoded(words, first, kind):
    return line.convert_from_registers(words[first:first + kind.value[1]], kind)


def everything():
    reply = line.read_input_registers(0, count=86, device_id=unit)
    assert not reply.isError(), reply
    return reply.registers


def parameter(first):
    return decoded(line.read_holding_registers(first, count=4, device_id=unit).registers, 0, types.FLOAT64)


def write(number):
    return line.write_registers(place, line.convert_to_registers(number, types.FLOAT64), device_id=unit)


one = everything()
time.sleep(0.1)
two = everything()
for words in (one, two):
    assert words[0] == 1, f"map {words[0]}"
    assert words[2] <= 5, f"state {words[2]}"
    nm, mm, um = (decoded(words, *at) for at in ((8, types.INT64), (20, types.FLOAT32), (28, types.INT32)))
    assert abs(mm - nm / 1e6) <= 1e-7 * abs(mm) + 1e-9, f"{nm} nm, {mm} mm"
    assert abs(um - nm / 1e3) <= 0.5, f"{nm} nm, {um} um"
    assert (words[3] != 0) == bool(words[1] & 1 << 7), f"fault {words[3]}, status {words[1]:b}"
    assert decoded(words, 78, types.UINT32) == names, "another list of parameters"
ticks = (decoded(two, 6, types.UINT32) - decoded(one, 6, types.UINT32)) % 2**32
frames = (decoded(two, 82, types.UINT32) - decoded(one, 82, types.UINT32)) % 2**32
assert 0 < ticks < 2**31, f"{ticks} ticks between two requests"
assert frames >= 1, "frames are not counted"
counts, least, most = (parameter(place + block) for block in (0, 1000, 2000))
assert least <= counts <= most, f"{counts} is not within {least} to {most}"
is_off = bool(two[1] & 1 << 9)
answer = write(counts * (1 + 2**-52))
if is_off:
    assert not answer.isError(), answer
    assert parameter(place) == counts * (1 + 2**-52)
    assert not write(counts).isError()
    assert parameter(place) == counts
else:
    assert answer.isError() and answer.exception_code == 6, answer
    assert parameter(place) == counts
answer = line.write_register(2, 3, device_id=unit)
assert answer.isError() and answer.exception_code == 2, answer
print(f"all right: {'off' if is_off else 'on'}, {ticks} ticks, {decoded(two, 8, types.INT64)} nm")
line.close()
