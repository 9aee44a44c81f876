// io/atomic_file.h -- a file that appears whole or not at all.
#pragma once
#include <functional>
#include <ostream>
#include <string>

namespace isoparm {
/// `write` fills a temporary file in the same folder, without a name where the file system offers that (else isoparm.tmp-<random>); it is
/// then flushed, checked, synced, named and renamed to `path`. On any failure it is removed, the old file is as it was, and Error(io) says
/// why. A program that is killed between naming and renaming (microseconds), or on a file system without O_TMPFILE, leaves isoparm.tmp-*.
/// Links are followed, also to a file that is not there yet. The new file has the permissions of the old one, without setuid and setgid.
void write_atomically(const std::string& path, const std::function<void(std::ostream&)>& write);
/// The same when another library does the writing: `write` gets a name of the temporary to open: its extension says nothing. What a pipe or
/// device is to get is made in memory first, as libraries go back in files.
void write_atomically_by_name(const std::string& path, const std::function<void(const std::string&)>& write);
/// Where `path` leads when its links are followed, whether or not there is a file; itself where it is no link. "" with errno where there is no way
/// (ELOOP, EACCES ...).
std::string behind_links(const std::string& path);
/// Removes what the process has not finished: before a crash ends it. May be called in a signal handler.
void remove_temporaries();
/// Whether a pipe or a device is being written, which may wait for another program. May be called in a signal handler.
bool writing_to_device();
}
