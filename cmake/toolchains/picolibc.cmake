# SPDX-License-Identifier: MIT
# What the bare-metal targets have in common: picolibc, its start-up code and its linker script, and
# semihosting. Included by the toolchain files, which set
#
#     rlvc_triple    of the compiler
#     rlvc_machine   compiler options that choose the processor
#     rlvc_flash, rlvc_flash_size, rlvc_ram, rlvc_ram_size    where the image lies
#     rlvc_emulator  the command that runs an image, up to its name
#
# RLVC_RAM_SIZE and RLVC_STACK_SIZE set what an image may have: the linker refuses more.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_C_COMPILER ${rlvc_triple}-gcc)
set(CMAKE_SIZE ${rlvc_triple}-size)
set(CMAKE_EXECUTABLE_SUFFIX_C .elf)

set(CMAKE_C_FLAGS_INIT
    "${rlvc_machine} --specs=picolibc.specs -ffunction-sections -fdata-sections")
set(CMAKE_EXE_LINKER_FLAGS_INIT
    "--crt0=semihost --oslib=semihost -Wl,--gc-sections \
-Wl,--defsym=__flash=${rlvc_flash} -Wl,--defsym=__flash_size=${rlvc_flash_size} \
-Wl,--defsym=__ram=${rlvc_ram}")
set(RLVC_RAM_SIZE ${rlvc_ram_size} CACHE STRING "Memory of an image, in bytes")

set(CMAKE_CROSSCOMPILING_EMULATOR
    ${rlvc_emulator} -nographic -monitor none -serial none -chardev stdio,id=s0
    -semihosting-config enable=on,target=native,chardev=s0 -kernel)
