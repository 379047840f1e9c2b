// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/io/png.hpp"

#include <fmt/format.h>
#include <png.h>

#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "image.hpp"
#include "parse_error.hpp"

namespace gridmerge {

namespace {

// libpng reports errors by longjmp, which must not skip a destructor: the two functions below that call
// setjmp hold plain values only, and everything with a destructor lives in their callers. libpng's simplified
// interface would spare us this, but it takes 16-bit samples for linear light and changes them.
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

// What the header says, and the size of a row in the file.
struct Header {
  png_uint_32 width, height;
  std::size_t file_row_bytes;
};

bool read_header(Reader& reader, Header& header) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_set_read_fn(reader.png, &reader, on_read);
  png_set_user_limits(reader.png, PNG_UINT_31_MAX,
                      PNG_UINT_31_MAX);  // check_image_size decides, as for any format
  png_read_info(reader.png, reader.info);
  header.width = png_get_image_width(reader.png, reader.info);
  header.height = png_get_image_height(reader.png, reader.info);
  header.file_row_bytes = png_get_rowbytes(reader.png, reader.info);
  png_set_expand(reader.png);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  return true;
}

bool read_pixels(Reader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);
  return true;
}

}  // namespace

PngImage decode_png(std::string_view bytes, std::size_t max_pixels) {
  Reader reader(bytes);
  Header header{};
  if (!read_header(reader, header)) reader.fail();
  check_image_size(header.width, header.height, max_pixels);
  // Deflate cannot shrink data more than 1032 times: a small file cannot make us take memory for a large
  // image.
  if (header.file_row_bytes * header.height / 1032 > bytes.size())
    throw ParseError("the image data end early");

  PngImage image;
  image.width = static_cast<int>(header.width);
  image.height = static_cast<int>(header.height);
  image.channels = png_get_channels(reader.png, reader.info);
  image.bit_depth = png_get_bit_depth(reader.png, reader.info);
  const std::size_t row_bytes = png_get_rowbytes(reader.png, reader.info);
  image.samples.resize(row_bytes * header.height);
  std::vector<png_bytep> rows(header.height);
  for (std::size_t row = 0; row < rows.size(); ++row) rows[row] = image.samples.data() + row * row_bytes;
  if (!read_pixels(reader, rows.data())) reader.fail();
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

}  // namespace gridmerge
