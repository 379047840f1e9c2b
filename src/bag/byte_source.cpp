// SPDX-License-Identifier: Apache-2.0
#include "bag/byte_source.hpp"

#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <new>
#include <utility>
#include <vector>

#include "gridmerge/grid/execution.hpp"
#include "io/parse_error.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::size_t kStep = std::size_t{1} << 16;

class FilePart : public ByteSource {
 public:
  FilePart(const RandomAccessFile& file, std::uint64_t begin, std::uint64_t end)
      : file_(file), next_(begin), end_(std::max(begin, end)) {}

  std::size_t read(char* to, std::size_t count) override {
    const std::size_t wanted = static_cast<std::size_t>(std::min<std::uint64_t>(count, end_ - next_));
    const std::size_t got = file_.read(next_, to, wanted);
    next_ += got;
    return got;
  }

 private:
  const RandomAccessFile& file_;
  std::uint64_t next_;
  std::uint64_t end_;
};

class Text : public ByteSource {
 public:
  explicit Text(std::string_view text) : left_(text) {}

  std::size_t read(char* to, std::size_t count) override {
    const std::size_t got = left_.copy(to, count);
    left_.remove_prefix(got);
    return got;
  }

 private:
  std::string_view left_;
};

// What packed streams share: a piece of the packed bytes, of which a part is used. `Unpack` unpacks what it
// can into `to` and says how much of either it used, and whether a frame has ended.
struct Progress {
  std::size_t used = 0;
  std::size_t made = 0;
  bool frame_ended = false;
};

class Unpacking : public ByteSource {
 public:
  explicit Unpacking(std::unique_ptr<ByteSource> packed) : packed_(std::move(packed)), piece_(kStep) {}

  std::size_t read(char* to, std::size_t count) override {
    std::size_t made = 0;
    while (made < count) {
      throw_if_cancelled();
      if (begin_ == end_ && !is_at_end_) {
        begin_ = 0;
        end_ = packed_->read(piece_.data(), piece_.size());
        is_at_end_ = end_ == 0;
      }
      // Between two frames, what is left of the last one's output has been given.
      if (is_at_end_ && between_frames_) break;
      const Progress step = unpack({piece_.data() + begin_, end_ - begin_}, to + made, count - made);
      if (is_at_end_ && step.made == 0) throw ParseError("its packed bytes end early");
      begin_ += step.used;
      made += step.made;
      between_frames_ = step.frame_ended;
    }
    return made;
  }

 private:
  virtual Progress unpack(std::string_view packed, char* to, std::size_t room) = 0;

  std::unique_ptr<ByteSource> packed_;
  std::vector<char> piece_;
  std::size_t begin_ = 0;  ///< of what is not used yet
  std::size_t end_ = 0;
  bool is_at_end_ = false;
  bool between_frames_ = true;
};

class Zstd : public Unpacking {
 public:
  explicit Zstd(std::unique_ptr<ByteSource> packed) : Unpacking(std::move(packed)) {
    if (!context_) throw std::bad_alloc();
  }

 private:
  Progress unpack(std::string_view packed, char* to, std::size_t room) override {
    ZSTD_inBuffer in{packed.data(), packed.size(), 0};
    ZSTD_outBuffer out{to, room, 0};
    const std::size_t left = ZSTD_decompressStream(context_.get(), &out, &in);
    if (ZSTD_isError(left) != 0)
      throw ParseError(fmt::format("its Zstandard bytes do not unpack: {}", ZSTD_getErrorName(left)));
    return {in.pos, out.pos, left == 0};
  }

  struct Free {
    void operator()(ZSTD_DStream* context) const { ZSTD_freeDStream(context); }
  };
  std::unique_ptr<ZSTD_DStream, Free> context_{ZSTD_createDStream()};  // its windows: up to 128 MiB
};

class Lz4 : public Unpacking {
 public:
  explicit Lz4(std::unique_ptr<ByteSource> packed) : Unpacking(std::move(packed)) {
    LZ4F_dctx* context = nullptr;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) throw std::bad_alloc();
    context_.reset(context);
  }

 private:
  Progress unpack(std::string_view packed, char* to, std::size_t room) override {
    std::size_t used = packed.size(), made = room;
    const std::size_t left = LZ4F_decompress(context_.get(), to, &made, packed.data(), &used, nullptr);
    if (LZ4F_isError(left) != 0)
      throw ParseError(fmt::format("its LZ4 bytes do not unpack: {}", LZ4F_getErrorName(left)));
    return {used, made, left == 0};
  }

  struct Free {
    void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
  };
  std::unique_ptr<LZ4F_dctx, Free> context_;
};

}  // namespace

std::unique_ptr<ByteSource> file_part(const RandomAccessFile& file, std::uint64_t begin, std::uint64_t end) {
  return std::make_unique<FilePart>(file, begin, end);
}

std::unique_ptr<ByteSource> text_source(std::string_view text) {
  return std::make_unique<Text>(text);
}

std::unique_ptr<ByteSource> unpack_zstd(std::unique_ptr<ByteSource> packed) {
  return std::make_unique<Zstd>(std::move(packed));
}

std::unique_ptr<ByteSource> unpack_lz4(std::unique_ptr<ByteSource> packed) {
  return std::make_unique<Lz4>(std::move(packed));
}

bool looks_like_zstd(std::string_view bytes) {
  return bytes.starts_with("\x28\xb5\x2f\xfd");
}

std::string read_all(ByteSource& source, std::size_t max_bytes) {
  std::string bytes;
  while (true) {
    const std::size_t held = bytes.size();
    bytes.resize(held + kStep);
    const std::size_t got = source.read(bytes.data() + held, kStep);
    bytes.resize(held + got);
    if (bytes.size() > max_bytes)
      throw ParseError(fmt::format("it unpacks to more than {} bytes", max_bytes));
    if (got < kStep) return bytes;
  }
}

}  // namespace gridmerge::internal
