"""Programs have the protections of cmake/hardened.cmake: addresses that differ from run to run, tables of addresses that are complete at the
start and cannot be written after, no stack that can be run, guards on the stack, and checked copies of the C library's functions.

usage: hardened_test.py PROGRAM...
"""
import re
import shutil
import subprocess
import sys


def read(program, *options):
    return subprocess.run(['readelf', '-W', *options, program], check=True, capture_output=True, text=True).stdout


def missing_in(program):
    header, segments, dynamic = read(program, '-h'), read(program, '-l'), read(program, '-d')
    symbols = read(program, '--dyn-syms')
    stack = re.search(r'GNU_STACK(?: +0x\w+)+ +(\w+)', segments)
    has = {
        'position independence': re.search(r'Type: +DYN', header) and (program.endswith('.so') or re.search(r'FLAGS_1.* PIE', dynamic)),
        'a table of addresses that cannot be written': 'GNU_RELRO' in segments and 'BIND_NOW' in dynamic,
        'code that is never written': 'TEXTREL' not in dynamic and not re.search(r'LOAD .* RWE ', segments),
        'a stack that cannot be run': stack and stack[1] == 'RW',
        'guards on the stack': '__stack_chk_fail' in symbols,
        'checked functions': re.search(r'__(?!stack)\w+_chk\b', symbols),
    }
    return [what for what, there in has.items() if not there]


if not shutil.which('readelf'):
    print('there is no readelf')
    sys.exit(77)
faults = [f'{program}: without {what}' for program in sys.argv[1:] for what in missing_in(program)]
assert not faults, '\n'.join(faults)
