"""Programs take the system's C++ standard library, whatever the compiler would link (cmake/standard_library.cmake).

usage: standard_library_test.py SOURCE COMPILER
"""
import pathlib
import subprocess
import sys
import tempfile

PROJECT = '''cmake_minimum_required(VERSION 3.25)
project(linked LANGUAGES CXX)
set(CMAKE_CXX_STANDARD 20)
{include}
add_executable(linked {source}/cmake/linked_standard_library.cpp)
target_link_libraries(linked PRIVATE ${{CMAKE_DL_LIBS}})
'''


def own_library_of(folder, source, compiler, include, flags):
    """What the program says of the standard library that it was linked with: nothing where that is the system's."""
    folder.mkdir()
    (folder / 'CMakeLists.txt').write_text(PROJECT.format(source=source, include=include))
    cmake = ['cmake', '-G', 'Ninja', '-S', folder, '-B', folder / 'build', f'-DCMAKE_CXX_COMPILER={compiler}', f'-DCMAKE_EXE_LINKER_FLAGS={flags}']
    subprocess.run(cmake, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(['cmake', '--build', folder / 'build'], check=True, stdout=subprocess.DEVNULL)
    return subprocess.run([folder / 'build/linked'], check=True, capture_output=True, text=True).stdout


def main(source, compiler):
    mended = f'include({source}/cmake/standard_library.cmake)'
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        archive = own_library_of(folder / 'archive', source, compiler, '', '-static-libstdc++')
        assert 'libstdc++.so' in archive, f'{compiler} -static-libstdc++ linked no archive: nothing is tested'
        own = own_library_of(folder / 'mended', source, compiler, mended, '-static-libstdc++')
        assert not own, f'linked with an archive beside {own}'


main(*sys.argv[1:])
