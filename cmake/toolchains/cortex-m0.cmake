# SPDX-License-Identifier: MIT
# Arm Cortex-M0: QEMU's microbit, with 16 KiB of memory. What needs more runs on an MPS2 board, whose Cortex-M3
# has all instructions of an M0.
set(rlvc_triple arm-none-eabi)
set(rlvc_machine "-mthumb -mcpu=cortex-m0")
set(rlvc_flash 0x0)
set(rlvc_flash_size 0x40000)
set(rlvc_ram 0x20000000)
set(rlvc_ram_size 0x4000)
set(rlvc_emulator qemu-system-arm -M microbit)
include(${CMAKE_CURRENT_LIST_DIR}/picolibc.cmake)
list(TRANSFORM CMAKE_CROSSCOMPILING_EMULATOR REPLACE "^microbit$" mps2-an385
     OUTPUT_VARIABLE RLVC_LARGE_EMULATOR)
