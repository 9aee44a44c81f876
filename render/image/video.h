// video.h -- films from frames, by ffmpeg.
#pragma once
#include <string>

namespace isoparm {

/// Is this the path of a film: .mp4 (H.264), .webm (VP9) or .gif, in any case of letters?
bool is_video(const std::string& path);
/// Can that film hold transparent pixels?
bool holds_transparency(const std::string& path);
/// Throws Error(io) that says what to do where there is no ffmpeg in PATH.
void find_encoder(const std::string& path);

/// The film of `frames` ("folder/%05d.png", numbered from 0, all of one size), `rate` a second, colours by BT.709, for .mp4 and .webm without the
/// last column or row where their number is odd. Appears whole or not at all, and its bytes depend on the frames and on ffmpeg's version only.
/// Throws Error(io) with the last that ffmpeg said.
void write_video(const std::string& path, const std::string& frames, double rate, bool transparent);

}  // namespace isoparm
