// A recorded frame as bytes and back: the format "gnomon frame", versions 1 to 3
// (docs/frame-format.md).
// Invariant: the bytes are a function of the frame's values alone, of no address and no machine;
// what encode_frame wrote comes back from decode_frame to be encoded to the very same bytes (of
// buffers that take at most kMaxFrameBufferBytes).
// What the targets held is not part of a frame: a decoded one begins with fresh buffers.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <stdexcept>
#include <variant>
#include <vector>

#include "raster/buffers.h"
#include "raster/frame.h"

namespace gnomon::raster {

/// Thrown for bytes that are no frame. what() is one line: the offset, what is wrong, the value.
class FormatError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

using Buffer = std::variant<ColorBuffer, DepthBuffer, StencilBuffer>;

/// A frame with the buffers that it draws to and reads. Buffers keep their addresses when the whole
/// is moved.
struct RecordedFrame {
  /// In the order in which the frame mentions them first.
  std::deque<Buffer> buffers;
  Frame frame;

  RecordedFrame() = default;
  RecordedFrame(RecordedFrame&&) = default;
  RecordedFrame& operator=(RecordedFrame&&) = default;
};

/// Most memory that all buffers of a decoded frame may take together, in bytes.
inline constexpr std::uint64_t kMaxFrameBufferBytes = std::uint64_t{4} << 30;

/// The frame's bytes, in the oldest version that has all of its fields. Arrays, textures and
/// pictures of equal content are stored once.
/// Precondition: what the frame borrows is there. Misuse: an array or a list of 2^32 - 1 or more.
std::vector<std::uint8_t> encode_frame(const Frame& frame);

/// The frame that these bytes hold, on buffers as they are constructed; it owns what it borrows.
/// No size is believed before it is compared with the bytes that are left, and buffers of more than
/// `max_buffer_bytes` together are refused before one is made. Throws FormatError.
RecordedFrame decode_frame(std::span<const std::uint8_t> bytes,
                           std::uint64_t max_buffer_bytes = kMaxFrameBufferBytes);

}  // namespace gnomon::raster
