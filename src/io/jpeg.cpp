// SPDX-License-Identifier: Apache-2.0
#include "io/jpeg.hpp"

#include <fmt/format.h>

#include <array>
#include <csetjmp>
#include <cstdio>
#include <new>
#include <vector>

// After <cstdio>, which it needs.
#include <jerror.h>
#include <jpeglib.h>

#include "io/parse_error.hpp"

namespace gridmerge::internal {

namespace {

constexpr int kMaxScans = 100;  // ordinary progressive files have about ten

// libjpeg reports errors by a function that must not return: it jumps to where guarded() stands.
struct Reader {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf failed{};
  std::array<char, JMSG_LENGTH_MAX> message{};

  Reader();
  ~Reader() { jpeg_destroy_decompress(&jpeg); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
};

Reader& reader_of(j_common_ptr jpeg) {
  return *static_cast<Reader*>(jpeg->client_data);
}

[[noreturn]] void on_error(j_common_ptr jpeg) {
  Reader& reader = reader_of(jpeg);
  (*jpeg->err->format_message)(jpeg, reader.message.data());
  std::longjmp(reader.failed, 1);
}

// A warning is of data that is broken: the library would go on with gray. Only bytes between the parts of a
// file, which some cameras and editors leave, do no harm.
void on_message(j_common_ptr jpeg, int level) {
  if (level < 0 && jpeg->err->msg_code != JWRN_EXTRANEOUS_DATA) on_error(jpeg);
}

void on_progress(j_common_ptr jpeg) {
  if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number <= kMaxScans) return;
  Reader& reader = reader_of(jpeg);
  std::snprintf(reader.message.data(), reader.message.size(), "it has more than %d scans", kMaxScans);
  std::longjmp(reader.failed, 1);
}

// Runs calls of libjpeg. A longjmp must not skip a destructor, so `calls` holds nothing that has one.
template <typename Calls>
void guarded(Reader& reader, const Calls& calls) {
  if (setjmp(reader.failed)) throw ParseError(fmt::format("not a readable JPEG: {}", reader.message.data()));
  calls();
}

Reader::Reader() {
  jpeg.err = jpeg_std_error(&errors);
  errors.error_exit = on_error;
  errors.emit_message = on_message;
  progress.progress_monitor = on_progress;
  jpeg.client_data = this;
  guarded(*this, [&] { jpeg_create_decompress(&jpeg); });
  jpeg.progress = &progress;
}

}  // namespace

bool looks_like_jpeg(std::string_view bytes) {
  return bytes.starts_with("\xff\xd8\xff");
}

std::optional<ImageSize> jpeg_size(std::string_view head) {
  const auto byte = [&](std::size_t at) { return static_cast<std::uint8_t>(head[at]); };
  const auto number = [&](std::size_t at) {
    return static_cast<std::uint64_t>(byte(at) << 8 | byte(at + 1));
  };
  // Parts begin with 0xff and their kind, then their length, which counts itself.
  for (std::size_t at = 2; at + 9 <= head.size();) {
    if (byte(at) != 0xff || byte(at + 1) == 0xff) {  // bytes between the parts, as libjpeg passes over them
      ++at;
      continue;
    }
    const std::uint8_t kind = byte(at + 1);
    constexpr std::string_view kNoFrame = "\xc4\xc8\xcc";  // tables, and one that is reserved
    if (kind >= 0xc0 && kind <= 0xcf && kNoFrame.find(static_cast<char>(kind)) == std::string_view::npos)
      return ImageSize{number(at + 7), number(at + 5)};
    const bool has_length = kind > 0x01 && (kind < 0xd0 || kind > 0xd9);
    at += has_length ? 2 + number(at + 2) : 2;
  }
  return std::nullopt;
}

MapImage decode_jpeg(std::string_view bytes, std::size_t max_pixels) {
  Reader reader;
  jpeg_decompress_struct& jpeg = reader.jpeg;
  guarded(reader, [&] {
    jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&jpeg, TRUE);
  });
  check_image_size(jpeg.image_width, jpeg.image_height, max_pixels);
  if (jpeg.arith_code) throw ParseError("a JPEG with arithmetic coding: save it as PNG");
  // A block of 64 pixels takes a bit at least: a small file cannot make us take memory for a large image.
  const std::size_t pixels = static_cast<std::size_t>(jpeg.image_width) * jpeg.image_height;
  if (pixels / 512 > bytes.size()) throw ParseError("the image data end early");
  const bool is_gray = jpeg.num_components == 1;
  if (!is_gray && jpeg.num_components != 3)
    throw ParseError("a JPEG that is neither gray nor RGB: save it as PNG");
  jpeg.out_color_space = is_gray ? JCS_GRAYSCALE : JCS_RGB;
  jpeg.dct_method = JDCT_ISLOW;  // the exact one, whatever the build prefers
  guarded(reader, [&] { jpeg_start_decompress(&jpeg); });

  MapImage image;
  image.width = static_cast<int>(jpeg.image_width);
  image.height = static_cast<int>(jpeg.image_height);
  image.white = is_gray ? 255 : 3 * 255;
  image.is_lossy = true;
  image.lightness.reserve(pixels);
  const std::size_t channels = is_gray ? 1 : 3;
  std::vector<JSAMPLE> row(static_cast<std::size_t>(jpeg.output_width) * channels);
  JSAMPROW rows[] = {row.data()};
  while (image.lightness.size() < pixels) {
    guarded(reader, [&] { jpeg_read_scanlines(&jpeg, rows, 1); });
    for (std::size_t at = 0; at < row.size(); at += channels) {
      std::uint32_t sum = 0;
      for (std::size_t channel = 0; channel < channels; ++channel) sum += row[at + channel];
      image.lightness.push_back(static_cast<std::uint16_t>(sum));
    }
  }
  guarded(reader, [&] { jpeg_finish_decompress(&jpeg); });
  return image;
}

}  // namespace gridmerge::internal
