// image_loader.h -- the module isoparm_image.so, loaded when it is first asked for.
#pragma once
#include "image/image_module.h"

namespace isoparm {

/// Its functions, as image_module.h tells them.
struct ImageModule {
    decltype(&isoparm_image_write) write;
    decltype(&isoparm_image_read) read;
    decltype(&isoparm_image_open) open;
    decltype(&isoparm_image_part) part;
    decltype(&isoparm_image_rows) rows;
    decltype(&isoparm_image_close) close;
    decltype(&isoparm_image_create) create;
    decltype(&isoparm_image_put) put;
    decltype(&isoparm_image_finish) finish;
    decltype(&isoparm_image_threads) threads;
};

/// Throws Error(io) that says where it was looked for. Takes about half a second the first time. Thread-safe.
const ImageModule& image_module();

}  // namespace isoparm
