# SPDX-License-Identifier: MIT
# Arm Cortex-M4 with a floating-point unit: QEMU's MPS2 board AN386.
set(rlvc_triple arm-none-eabi)
set(RLVC_FLOATING_POINT ON)
set(RLVC_LONG_BALANCE ON) # the M7 plays it to the end in each run of the tests
set(rlvc_machine "-mthumb -mcpu=cortex-m4 -mfloat-abi=hard -mfpu=fpv4-sp-d16")
set(rlvc_flash 0x0)
set(rlvc_flash_size 0x400000)
set(rlvc_ram 0x20000000)
set(rlvc_ram_size 0x400000)
set(rlvc_emulator qemu-system-arm -icount shift=6,sleep=off -M mps2-an386)
include(${CMAKE_CURRENT_LIST_DIR}/picolibc.cmake)
