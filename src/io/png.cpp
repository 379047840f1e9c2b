// SPDX-License-Identifier: Apache-2.0
#include "io/png.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <functional>
#include <new>
#include <stdexcept>
#include <vector>

#include "io/image.hpp"
#include "io/parse_error.hpp"
#include "io/png_rows.hpp"

namespace gridmerge::internal {

namespace {

// A row of 2^24 pixels takes 128 MB, and libpng holds some of them; so many rows take seconds.
constexpr std::uint32_t kMaxSide = 1U << 24;

// libpng's simplified interface would spare us the longjmp below, but it takes 16-bit samples for linear
// light and changes them.
struct Reader {
  std::string_view rest;
  std::array<char, 160> error{};
  png_structp png = nullptr;
  png_infop info = nullptr;

  explicit Reader(std::string_view bytes);
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  [[noreturn]] void fail() const { throw ParseError(fmt::format("not a readable PNG: {}", error.data())); }
};

void on_error(png_structp png, png_const_charp message) {
  auto* reader = static_cast<Reader*>(png_get_error_ptr(png));
  std::snprintf(reader->error.data(), reader->error.size(), "%s", message);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}  // the library prints nothing

void on_read(png_structp png, png_bytep target, std::size_t count) {
  auto* reader = static_cast<Reader*>(png_get_io_ptr(png));
  if (count > reader->rest.size()) png_error(png, "the file ends early");
  std::memcpy(target, reader->rest.data(), count);
  reader->rest.remove_prefix(count);
}

Reader::Reader(std::string_view bytes) : rest(bytes) {
  png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
  if (png != nullptr) info = png_create_info_struct(png);
  if (info == nullptr) throw std::bad_alloc();
}

// Runs calls of libpng, which reports errors by longjmp to here. A longjmp must not skip a destructor, so
// `calls` holds nothing that has one.
template <typename Calls>
void guarded(const Reader& reader, const Calls& calls) {
  if (setjmp(png_jmpbuf(reader.png))) reader.fail();
  calls();
}

}  // namespace

void read_png(std::string_view bytes, std::size_t max_pixels,
              const std::function<void(const PngFormat&)>& begin,
              const std::function<void(const PngRow&)>& row) {
  Reader reader(bytes);
  const png_structp png = reader.png;
  const png_infop info = reader.info;
  guarded(reader, [&] {
    png_set_read_fn(png, &reader, on_read);
    png_set_user_limits(png, PNG_UINT_31_MAX,
                        PNG_UINT_31_MAX);  // check_image_size decides, as for any format
    // Of text, gamma and the like, which no map needs: libpng takes memory for the length that such a chunk
    // claims, up to 2 GB.
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_read_info(png, info);
  });
  const std::uint32_t width = png_get_image_width(png, info), height = png_get_image_height(png, info);
  check_image_size(width, height, max_pixels);
  if (std::max(width, height) > kMaxSide)
    throw ParseError(
        fmt::format("a side of {} pixels exceeds the limit of {}", std::max(width, height), kMaxSide));
  // Deflate cannot shrink data more than 1032 times: a small file cannot make us take memory for a large
  // image.
  if (png_get_rowbytes(png, info) * height / 1032 > bytes.size())
    throw ParseError("the image data end early");

  guarded(reader, [&] {
    png_set_expand(png);
    png_read_update_info(png, info);  // takes memory for a row, hence not before the checks
  });
  begin({static_cast<int>(width), static_cast<int>(height), png_get_channels(png, info),
         png_get_bit_depth(png, info)});
  std::vector<std::uint8_t> samples(png_get_rowbytes(png, info));
  const auto read_row = [&] { guarded(reader, [&] { png_read_row(png, samples.data(), nullptr); }); };
  if (png_get_interlace_type(png, info) == PNG_INTERLACE_NONE) {
    for (std::uint32_t y = 0; y < height; ++y) {
      read_row();
      row({static_cast<int>(y), 0, 1, static_cast<int>(width), samples.data()});
    }
  } else {
    for (int pass = 0; pass < PNG_INTERLACE_ADAM7_PASSES; ++pass) {
      const int columns = static_cast<int>(PNG_PASS_COLS(width, pass));
      if (columns == 0) continue;  // libpng passes over it as well
      const int first = PNG_PASS_START_COL(pass), step = 1 << PNG_PASS_COL_SHIFT(pass);
      for (std::uint32_t i = 0; i < PNG_PASS_ROWS(height, pass); ++i) {
        read_row();
        row({static_cast<int>(PNG_ROW_FROM_PASS_ROW(i, pass)), first, step, columns, samples.data()});
      }
    }
  }
  guarded(reader, [&] { png_read_end(png, nullptr); });
}

PngImage decode_png(std::string_view bytes, std::size_t max_pixels) {
  PngImage image;
  std::size_t pixel_bytes = 0;
  const auto begin = [&](const PngFormat& format) {
    image.width = format.width;
    image.height = format.height;
    image.channels = format.channels;
    image.bit_depth = format.bit_depth;
    pixel_bytes = format.pixel_bytes();
    image.samples.resize(pixel_bytes * static_cast<std::size_t>(image.width) *
                         static_cast<std::size_t>(image.height));
  };
  read_png(bytes, max_pixels, begin, [&](const PngRow& row) {
    std::size_t target = (static_cast<std::size_t>(row.y) * static_cast<std::size_t>(image.width) +
                          static_cast<std::size_t>(row.first)) *
                         pixel_bytes;
    for (int i = 0; i < row.count; ++i, target += static_cast<std::size_t>(row.step) * pixel_bytes)
      std::memcpy(&image.samples[target], row.samples + static_cast<std::size_t>(i) * pixel_bytes,
                  pixel_bytes);
  });
  return image;
}

std::string encode_png(const PngImage& image) {
  constexpr std::array<png_uint_32, 4> kFormats{PNG_FORMAT_GRAY, PNG_FORMAT_GA, PNG_FORMAT_RGB,
                                                PNG_FORMAT_RGBA};
  const bool sizes_valid = image.width > 0 && image.height > 0 && image.channels >= 1 && image.channels <= 4;
  if (!sizes_valid || image.bit_depth != 8 ||
      image.samples.size() != static_cast<std::size_t>(image.width) * image.height * image.channels) {
    throw std::invalid_argument(
        "a PNG image needs positive sizes, 1 to 4 channels of 8 bits and samples to match");
  }

  png_image control{};
  control.version = PNG_IMAGE_VERSION;
  control.width = static_cast<png_uint_32>(image.width);
  control.height = static_cast<png_uint_32>(image.height);
  control.format = kFormats[static_cast<std::size_t>(image.channels - 1)];
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(control);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&control, bytes.data(), &size, 0, image.samples.data(), 0, nullptr)) {
    throw std::runtime_error(fmt::format("the PNG cannot be made: {}", control.message));
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace gridmerge::internal
