#include "model/train/run_folder.hpp"

#include <fcntl.h>

#include <chrono>

#include "base/checksum/checked_lines.hpp"
#include "base/checksum/checked_text.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/files/regular_file.hpp"
#include "base/text/printable.hpp"
#include "ingest/dataset/own_kind.hpp"
#include "model/train/tensorboard.hpp"

namespace actformer::model {
namespace {

/// Seconds since 1970.
double now() {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// Adds `text` to the file, and empties it.
void add_all(const std::filesystem::path& path, std::string& text) {
    if (text.empty()) return;
    append(path, text);
    text.clear();
}

/// Copies the file, and returns where to.
std::filesystem::path kept_as_damaged(const std::filesystem::path& path) {
    std::string bytes;
    read_in_pieces(path, [&](std::string_view piece) { bytes += piece; });
    const std::filesystem::path copy(path.string() + ".damaged");
    write_whole(copy, bytes);
    return copy;
}

}  // namespace

RunFolder::RunFolder(std::filesystem::path folder, bool tensorboard)
    : folder_(std::move(folder)), tensorboard_(tensorboard) {
    ingest::refuse_other_folder(folder_, ingest::own::training);
    make_folders(folder_);
    lock_ = FileLock::if_free(folder_ / "lock");
    if (!lock_)
        throw Error("{}: another training is writing there; wait for it, or choose another -o",
                    folder_.string());
}

void RunFolder::keep_to(const Config& config) const {
    if (std::filesystem::exists(this->config())) {
        expect_checksum_comment(this->config());
        if (const auto model = model_named_in(this->config()); model != config.model())
            throw Error("{}: holds a training of {}, not of '{}'; choose another -o", folder_.string(),
                        in_quotes(model), config.model());
        auto before = config.blank();
        before.load(this->config());
        const auto differences = config.differences(before);
        if (!differences.empty())
            throw Error("{}: holds a training with other settings ({}); choose another -o", folder_.string(),
                        fmt::join(differences, ", "));
    }
    write_whole(this->config(), with_checksum_comment(config.yaml()));
}

void RunFolder::log(const nlohmann::ordered_json& line) {
    unwritten_ += checked_line(line, ++lines_);
    if (tensorboard_) unwritten_events_ += tensorboard_event(line, now());
    write_log();
}

void RunFolder::write_log() {
    add_all(log_file(), unwritten_);
    add_all(events(), unwritten_events_);
}

void RunFolder::sync_log() {
    write_log();
    if (std::filesystem::exists(log_file())) sync_file(log_file());
}

std::string RunFolder::rewind_log(std::uint64_t epochs) {
    const auto path = log_file();
    if (tensorboard_) open_regular(events(), O_RDONLY);  // refuses links and what is no file
    const bool there = open_regular(path, O_RDONLY).get() >= 0;
    const auto lines = read_checked_lines(path);
    std::string kept, curves = tensorboard_head(now());
    std::uint64_t last = 0;
    lines_ = 0;
    for (const auto& line : lines.objects) {
        if (!line.contains("epoch") || !line["epoch"].is_number_unsigned() || line["epoch"] > epochs)
            continue;
        kept += checked_line(line, ++lines_);
        last =
            std::max(last, line["epoch"].get<std::uint64_t>());  // scores come behind lines of later epochs
        if (tensorboard_) curves += tensorboard_event(line, now());
    }
    auto note = lines.fault(path);
    if (!lines.damaged.empty() || lines.cut_short) note += ", and left out";
    if (note.empty() && last < epochs)
        note = there ? fmt::format("{}: its last lines are missing: it ends at epoch {} of {}", path.string(),
                                   last, epochs)
                     : fmt::format("{}: not there; curves begin at epoch {}", path.string(), epochs + 1);
    if (!lines.damaged.empty()) note += "; the log as it was is " + kept_as_damaged(path).string();
    if (there) write_whole(path, kept);
    if (tensorboard_) write_whole(events(), curves);
    return note;
}

}  // namespace actformer::model
