// Ends the program with one line on a processor that cannot run it. The dynamic linker calls
// functions in .preinit_array before all initializers, those of shared libraries included.
#include <cpuid.h>
#include <unistd.h>

#include "app/processor_check.h"

namespace {

fovea::app::ProcessorWords read_processor_words() {
  fovea::app::ProcessorWords words;
  unsigned eax = 0, ebx = 0, ecx = 0, edx = 0;
  if (__get_cpuid(1, &eax, &ebx, &ecx, &edx) != 0) words.leaf_1_ecx = ecx;
  if (__get_cpuid_count(7, 0, &eax, &ebx, &ecx, &edx) != 0) words.leaf_7_ebx = ebx;
  if (__get_cpuid(0x80000001, &eax, &ebx, &ecx, &edx) != 0) words.leaf_80000001_ecx = ecx;
  if ((words.leaf_1_ecx & bit_OSXSAVE) != 0) {
    asm volatile("xgetbv" : "=a"(eax), "=d"(edx) : "c"(0));
    words.xcr0 = eax;
  }
  return words;
}

void print(const char* text) {
  const char* end = text;
  while (*end != '\0') ++end;
  if (write(STDERR_FILENO, text, static_cast<unsigned long>(end - text)) < 0) return;
}

void check_processor() {
  const char* missing = fovea::app::missing_feature(read_processor_words());
  if (missing == nullptr) return;
  print("fovea: error: the processor lacks ");
  print(missing);
  print(
      ", this machine, use a processor with x86-64-v3 (from 2013 on) or build Fovea with "
      "-DFOVEA_X86_64_V3=OFF\n");
  _exit(1);
}

[[gnu::section(".preinit_array"), gnu::used]] void (*check_before_initializers)() = check_processor;

}  // namespace
