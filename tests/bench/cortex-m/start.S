/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Vector table and reset: data from where it is stored, bss to zero, main. With BENCH_IMAGE the image under test. */
  .syntax unified
  .thumb
  .section .vectors, "a"
  .word stack_top
  .word reset + 1
  .rept 14
  .word halt + 1
  .endr
  .text
  .thumb_func
  .global reset
reset:
  ldr r0, =data_start
  ldr r1, =data_end
  ldr r3, =data_source
3: cmp r0, r1
  bhs 4f
  ldr r2, [r3], #4
  str r2, [r0], #4
  b 3b
4:
  ldr r0, =bss_start
  ldr r1, =bss_end
  movs r2, #0
1: cmp r0, r1
  bhs 2f
  str r2, [r0], #4
  b 1b
2: bl main
  .thumb_func
halt:
  b halt
#ifdef BENCH_IMAGE
  .section .rodata.image, "a"
  .balign 8
  .global bench_image, bench_image_end
bench_image:
  .incbin BENCH_IMAGE
bench_image_end:
#endif
