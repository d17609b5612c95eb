"""Reads and writes an axis as a control would, with pymodbus.

usage: master.py serial|tcp ADDRESS UNIT off|on PLACE LIST
PLACE is the first register of motion.counts_per_mm, LIST the checksum of the list of parameters.
"""

import sys

from pymodbus import FramerType
from pymodbus.client import ModbusSerialClient, ModbusTcpClient

kind, address, unit, part, place, names = sys.argv[1:]
unit, place, names = int(unit), int(place), int(names)
if kind == "serial":
    line = ModbusSerialClient(address, framer=FramerType.RTU, baudrate=19200, timeout=2, retries=0)
else:
    host, port = address.split(":")
    line = ModbusTcpClient(host, port=int(port), framer=FramerType.RTU, timeout=2, retries=0)
assert line.connect(), f"no connection to {address}"
types = line.DATATYPE


def same(found, expected):
    assert found == expected, f"{found} is not {expected}"


def inputs(first, count):
    reply = line.read_input_registers(first, count=count, device_id=unit)
    assert not reply.isError(), reply
    return reply.registers


def value(first, kind):
    words = inputs(first, kind.value[1])
    return line.convert_from_registers(words, kind)


def refused(reply, code):
    assert reply.isError(), f"{reply} is no exception"
    same(reply.exception_code, code)


def write(first, number):
    words = line.convert_to_registers(number, types.FLOAT64)
    return line.write_registers(first, words, device_id=unit)


everything = inputs(0, 82)
same(line.read_holding_registers(0, count=82, device_id=unit).registers, everything)
same(value(0, types.UINT16), 1)
same(value(6, types.UINT32), 0x00010002)
same(value(8, types.INT64), -123456789)
same(value(12, types.INT64), -123456500)
same(value(16, types.INT32), 30000000)
same(value(18, types.INT32), -500)
assert abs(value(20, types.FLOAT32) - -123.456789) < 1e-5
same(value(30, types.INT16), 30000)
same(value(34, types.INT64), -7000000001)
same(value(78, types.UINT32), names)
bits = line.read_discrete_inputs(0, count=16, device_id=unit).bits
same([at for at, bit in enumerate(bits) if bit], {"off": [2, 8, 9, 10, 11], "on": [0, 2, 8, 10, 11]}[part])

if part == "off":
    same(value(place, types.FLOAT64), 1000.0)
    same(value(place + 1000, types.FLOAT64), 0.001)
    same(value(place + 2000, types.FLOAT64), 1e7)
    same(value(place + 3000, types.FLOAT64), 1000.0)
    assert not write(place, 1234.5678901234567).isError()
    same(value(place, types.FLOAT64), 1234.5678901234567)
    same(value(81, types.UINT16), 0)
    refused(write(place, 1e8), 3)
    same(value(81, types.UINT16), 24)
    refused(write(place + 1, 1.0), 2)
    refused(line.write_register(place, 1, device_id=unit), 2)
    refused(line.write_register(5000, 1, device_id=unit), 3)
    assert not line.write_register(5000, 0x5A5A, device_id=unit).isError()
else:
    refused(write(place, 1000.0), 6)
    same(value(81, types.UINT16), 25)
    refused(line.write_register(5000, 0x5A5A, device_id=unit), 6)

refused(line.read_input_registers(86, count=1, device_id=unit), 2)
refused(line.read_coils(0, count=1, device_id=unit), 2)
refused(line.write_coil(0, True, device_id=unit), 2)
refused(line.read_device_information(device_id=unit), 1)
refused(line.readwrite_registers(read_address=0, read_count=1, address=0, values=[1], device_id=unit), 1)
# It goes on, whatever it was asked.
same(inputs(0, 1), [1])
line.close()
print("all right")
