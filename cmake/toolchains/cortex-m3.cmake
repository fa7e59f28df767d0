# SPDX-License-Identifier: MIT
# Arm Cortex-M3: QEMU's MPS2 board AN385. An instruction takes 64 ns.
set(rlvc_triple arm-none-eabi)
set(rlvc_machine "-mthumb -mcpu=cortex-m3")
set(rlvc_flash 0x0)
set(rlvc_flash_size 0x400000)
set(rlvc_ram 0x20000000)
set(rlvc_ram_size 0x400000)
set(rlvc_emulator qemu-system-arm -icount shift=6,sleep=off -M mps2-an385)
set(RLVC_EXACT_COUNT ON) # of instructions: core/TIME.md is of this target
include(${CMAKE_CURRENT_LIST_DIR}/picolibc.cmake)
