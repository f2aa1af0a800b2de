// libjpeg's errors as a jump back, with their reason; for the modules that link it.
#pragma once

#include <cstddef>
#include <cstdio>
// After <cstdio>, whose FILE it needs.
#include <jpeglib.h>

#include <csetjmp>

namespace fovea {

/// libjpeg's error manager with the place to jump to. libjpeg sees the first member only.
struct JpegErrors {
  jpeg_error_mgr manager;
  std::jmp_buf failed;
  char message[JMSG_LENGTH_MAX];

  static JpegErrors& of(j_common_ptr codec) { return *reinterpret_cast<JpegErrors*>(codec->err); }
  [[noreturn]] static void fail(j_common_ptr codec) {
    JpegErrors& errors = of(codec);
    (*codec->err->format_message)(codec, errors.message);
    std::longjmp(errors.failed, 1);
  }

  /// The manager for a codec: errors jump, nothing is printed.
  jpeg_error_mgr* start() {
    jpeg_std_error(&manager);
    manager.error_exit = &fail;
    manager.output_message = [](j_common_ptr) {};
    return &manager;
  }
};

}  // namespace fovea
