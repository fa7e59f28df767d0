# SPDX-License-Identifier: MIT
# RISC-V, 32 bit, without a floating-point unit: QEMU's board virt.
set(rlvc_triple riscv64-unknown-elf)
set(rlvc_machine "-march=rv32imac -mabi=ilp32")
set(rlvc_flash 0x80000000)
set(rlvc_flash_size 0x200000)
set(rlvc_ram 0x80200000)
set(rlvc_ram_size 0x400000)
set(rlvc_emulator qemu-system-riscv32 -icount shift=0,sleep=off -M virt -bios none)
set(RLVC_PROVE_EXPORTS ON)
include(${CMAKE_CURRENT_LIST_DIR}/picolibc.cmake)
