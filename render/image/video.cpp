#include "image/video.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "error.h"
#include "io/atomic_file.h"
#include "scratch_folder.h"

extern char** environ;

namespace isoparm {
namespace {

namespace fs = std::filesystem;

std::string kind_of(const std::string& path) {
    std::string kind = fs::path(path).extension().string();
    std::transform(kind.begin(), kind.end(), kind.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return kind.empty() ? kind : kind.substr(1);
}

/// What ffmpeg is to do with the frames. One thread: x264's bytes depend on their number.
std::vector<std::string> encoding(const std::string& kind, bool transparent) {
    if (kind == "gif")
        return {"-filter_complex", "split[a][b];[a]palettegen=stats_mode=full[p];[b][p]paletteuse=dither=sierra2_4a", "-loop", "0"};
    const std::string even = "crop=trunc(iw/2)*2:trunc(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=", format = transparent ? "yuva420p" : "yuv420p";
    std::vector<std::string> all{"-vf", even + format, "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1"};
    const std::vector<std::string> codec = kind == "mp4" ? std::vector<std::string>{"-c:v", "libx264", "-preset", "slow", "-crf", "14", "-movflags", "+faststart"}
                                                         : std::vector<std::string>{"-c:v", "libvpx-vp9", "-crf", "18", "-b:v", "0", "-row-mt", "0"};
    all.insert(all.end(), codec.begin(), codec.end());
    return all;
}

/// Runs a program from PATH, without input, what it says going to `log`. How it ended, as waitpid() tells; -1 where it cannot be started.
int run(std::vector<std::string> words, const std::string& log) {
    std::vector<char*> arguments;
    for (std::string& w : words) arguments.push_back(w.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    ::posix_spawn_file_actions_init(&files);
    ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
    pid_t child = -1;
    const int error = ::posix_spawnp(&child, arguments[0], &files, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&files);
    if (error != 0) return -1;
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {}
    return status;
}

/// The last lines of a text, on one line.
std::string end_of(const std::string& log) {
    std::ifstream in(log);
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);)
        if (!line.empty()) lines.push_back(line);
    std::string text;
    for (std::size_t i = lines.size() > 3 ? lines.size() - 3 : 0; i < lines.size(); ++i) text += (text.empty() ? "" : "; ") + lines[i];
    return text.empty() ? "it said nothing" : text;
}

}  // namespace

bool is_video(const std::string& path) {
    const std::string kind = kind_of(path);
    return kind == "mp4" || kind == "webm" || kind == "gif";
}

bool holds_transparency(const std::string& path) { return kind_of(path) != "mp4"; }

void find_encoder(const std::string& path) {
    std::istringstream folders(std::getenv("PATH") ? std::getenv("PATH") : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (::access(((folder.empty() ? "." : folder) + "/ffmpeg").c_str(), X_OK) == 0) return;
    throw Error(ErrorKind::io, path + ": found no ffmpeg, which makes films of frames; install it (Debian: apt-get install ffmpeg), or write the frames alone: -o frame_%04d.png");
}

void write_video(const std::string& path, const std::string& frames, double rate, bool transparent) {
    const ScratchFolder scratch;
    const std::string kind = kind_of(path), made = scratch / ("film." + kind), log = scratch / "log";
    std::vector<std::string> words{"ffmpeg", "-nostdin", "-hide_banner", "-loglevel", "error", "-y", "-framerate", to_text(rate), "-i", frames};
    for (const std::string& w : encoding(kind, transparent)) words.push_back(w);
    for (const char* w : {"-threads", "1", "-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact"}) words.push_back(w);
    words.push_back(made);
    const int status = run(words, log);
    if (status < 0) throw Error(ErrorKind::io, path + ": ffmpeg cannot be started");
    if (status != 0) throw Error(ErrorKind::io, path + ": ffmpeg could not make this film of the frames: " + end_of(log));
    write_atomically(path, [&](std::ostream& out) {
        std::ifstream in(made, std::ios::binary);
        out << in.rdbuf();
        if (!in) throw Error(ErrorKind::io, made + ": cannot be read");
    });
}

}  // namespace isoparm
