// Where an ingest works, and how what it made gets to where it was asked for.
#pragma once

#include <filesystem>
#include <vector>

namespace actformer::ingest {

/// Of the work on OUT: beside it, in OUT.partial, which is renamed at the end. Where OUT is a folder already it may be a mount point or
/// a link, or its own folder not ours to write: then in OUT/.partial, and what is done is moved up.
std::filesystem::path workplace_of(const std::filesystem::path& out);

/// OUT, and where ingests work on it or did: no raw data, even where they lie among those. Without what others made at such a name.
std::vector<std::filesystem::path> own_folders(const std::filesystem::path& out);

/// Whether something is at OUT that an ingest neither fills nor left there unfinished. A folder with nothing in it may be filled, one of
/// a fresh file system too.
bool is_taken(const std::filesystem::path& out);

/// Throws Error, with the remedy, where something lies at `workplace` that no ingest left there: it is not to be worked in.
void expect_own_workplace(const std::filesystem::path& workplace);

/// Removes the workplace, unless something lies there that no ingest left.
void remove_workplace(const std::filesystem::path& workplace);

/// Moves the finished folder `data` of the workplace to `out`, once it is on the disk. Replaces nothing. Throws Error; where it fails
/// in the middle, take_back() undoes it.
void put_in_place(const std::filesystem::path& data, const std::filesystem::path& workplace,
                  const std::filesystem::path& out);

/// Moves what a killed put_in_place() has moved up back to `data`. Throws Error, with the remedy, and moves nothing, where that cannot
/// be told from what others made.
void take_back(const std::filesystem::path& data, const std::filesystem::path& workplace);

}  // namespace actformer::ingest
