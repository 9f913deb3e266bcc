#include "ingest/formats/babel/sequence_files.hpp"

#include <algorithm>
#include <array>

namespace actformer::ingest {
namespace {

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Small letters, without what tells words apart.
std::string squeezed(std::string_view name) {
    std::string out;
    for (const char c : name)
        if (c != '_' && c != ' ' && c != '-') out += lower(c);
    return out;
}

/// All names that a subset of AMASS has or had, squeezed; the first stands for it.
const std::vector<std::vector<std::string_view>>& subsets() {
    static const std::vector<std::vector<std::string_view>> all{{"kit"},
                                                                {"bmlrub", "biomotionlabntroje"},
                                                                {"cmu"},
                                                                {"bmlmovi"},
                                                                {"eyesjapandataset"},
                                                                {"ekut"},
                                                                {"accad"},
                                                                {"mpihdm05", "hdm05"},
                                                                {"dfaust67", "dfaust"},
                                                                {"transitionsmocap", "transitions"},
                                                                {"mpimosh", "mosh"},
                                                                {"tcdhandmocap", "tcdhands"},
                                                                {"sfu"},
                                                                {"totalcapture"},
                                                                {"mpilimits", "poseprior"},
                                                                {"ssmsynced", "ssm"},
                                                                {"humaneva"}};
    return all;
}

/// The name that stands for a subset, whichever of its names is given; other names squeezed.
std::string canonical(std::string_view name) {
    auto out = squeezed(name);
    for (const auto& names : subsets())
        if (std::find(names.begin(), names.end(), out) != names.end()) return std::string(names.front());
    return out;
}

bool is_subset(const std::string& canonical_name) {
    return std::any_of(subsets().begin(), subsets().end(),
                       [&](const auto& names) { return names.front() == canonical_name; });
}

/// Of a path, or of an archive and a member in it: "AMASS/CMU.tar.bz2:01/01_01_poses.npz".
std::vector<std::string_view> parts_of(std::string_view path) {
    std::vector<std::string_view> parts;
    while (!path.empty()) {
        const auto end = std::min(path.find_first_of("/:"), path.size());
        if (end > 0) parts.push_back(path.substr(0, end));
        path.remove_prefix(std::min(end + 1, path.size()));
    }
    return parts;
}

/// "subject/trial", alike for all ways to write it.
std::string key_of(std::string_view subject, std::string_view file) {
    for (const std::string_view ending : {".npz", "_poses", "_stageii"})
        if (file.size() > ending.size() &&
            squeezed(file.substr(file.size() - ending.size())) == squeezed(ending))
            file.remove_suffix(ending.size());
    std::string key;
    for (const char c : subject) key += c == ' ' ? '_' : lower(c);
    key += '/';
    for (const char c : file) key += c == ' ' ? '_' : lower(c);
    return key;
}

}  // namespace

bool SequenceFiles::add(std::string_view feat_p) {
    const auto parts = parts_of(feat_p);
    const auto sequence = count_++;
    if (parts.size() < 3) return false;
    const auto n = parts.size();
    auto set = canonical(parts[n - 3]), folder = n > 3 ? canonical(parts[n - 4]) : set;
    sets_.insert({set, folder});
    by_trial_[key_of(parts[n - 2], parts[n - 1])].push_back({sequence, std::move(folder), std::move(set)});
    return true;
}

std::vector<std::size_t> SequenceFiles::of(std::string_view path) const {
    const auto parts = parts_of(path);
    std::vector<std::size_t> out;
    if (parts.size() < 2) return out;
    const auto found = by_trial_.find(key_of(parts[parts.size() - 2], parts.back()));
    if (found == by_trial_.end()) return out;
    const auto set = subset_of(path);
    for (const auto& entry : found->second)
        if (set.empty() || entry.set == set || entry.folder == set) out.push_back(entry.sequence);
    return out;
}

std::string SequenceFiles::subset_of(std::string_view path) const {
    const auto parts = parts_of(path);
    std::string set;
    for (std::size_t i = 0; i + 2 < parts.size(); ++i)  // behind these are the subject and the trial
        for (const auto part : {parts[i], parts[i].substr(0, parts[i].find('.'))}) {  // as in CMU.tar.bz2
            auto name = canonical(part);
            if (!is_subset(name) && !sets_.contains(name)) continue;
            set = std::move(name);
            break;
        }
    return set;
}

}  // namespace actformer::ingest
