#include "server/import/import_cache.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace server {

namespace {

constexpr std::size_t kMostEntries = 10'000; // figures and failures are small, but not nothing

std::uint64_t bytes_of(const KnownImport& known)
{
    std::uint64_t bytes = 0;
    for (const auto& mesh : known.prepared)
        if (mesh) bytes += renderer::size_bytes(*mesh);
    if (known.picture) bytes += known.picture->bytes.size();
    return bytes;
}

bool answers_agree(const NamedDigests& answers, const NamedDigests& files)
{
    return std::all_of(answers.begin(), answers.end(), [&](const auto& answer) {
        const auto file = files.find(answer.first);
        return answer.second == (file == files.end() ? std::string() : file->second);
    });
}

} // namespace

ImportCache::Entries::const_iterator ImportCache::position(const std::string& main,
                                                           const NamedDigests& files) const
{
    const auto candidates = by_main_.find(main);
    if (candidates == by_main_.end()) return entries_.end();
    for (const auto& entry : candidates->second)
        if (answers_agree(entry->answers, files)) return entry;
    return entries_.end();
}

const KnownImport* ImportCache::peek(const std::string& main, const NamedDigests& files) const
{
    const auto entry = position(main, files);
    return entry == entries_.end() ? nullptr : &*entry;
}

KnownImport* ImportCache::find(const std::string& main, const NamedDigests& files)
{
    const auto entry = position(main, files);
    if (entry == entries_.end()) return nullptr;
    entries_.splice(entries_.begin(), entries_, entry);
    return &entries_.front();
}

void ImportCache::store(KnownImport known)
{
    std::vector<Entries::iterator>& same_main = by_main_[known.main];
    const auto same = std::find_if(same_main.begin(), same_main.end(), [&](const auto& entry) {
        return entry->answers == known.answers;
    });
    if (same != same_main.end()) {
        const Entries::iterator entry = *same;
        bytes_ -= bytes_of(*entry);
        for (std::size_t tree = 0; tree < known.prepared.size(); ++tree)
            if (!known.prepared[tree]) known.prepared[tree] = std::move(entry->prepared[tree]);
        if (!known.facts) known.facts = std::move(entry->facts);
        if (!known.picture) known.picture = std::move(entry->picture);
        *entry = std::move(known);
        entries_.splice(entries_.begin(), entries_, entry);
    } else {
        entries_.push_front(std::move(known));
        same_main.push_back(entries_.begin());
    }
    bytes_ += bytes_of(entries_.front());
    make_room();
}

void ImportCache::forget(Entries::iterator entry)
{
    const auto same_main = by_main_.find(entry->main);
    std::erase(same_main->second, entry);
    if (same_main->second.empty()) by_main_.erase(same_main);
    bytes_ -= bytes_of(*entry);
    entries_.erase(entry);
}

// Meshes and pictures go first, oldest first; what was just stored goes too if it alone is too large (who asked holds it
// anyway).
void ImportCache::make_room()
{
    for (auto entry = entries_.rbegin(); entry != entries_.rend() && bytes_ > most_bytes_; ++entry) {
        bytes_ -= bytes_of(*entry);
        entry->prepared = {};
        entry->picture = nullptr;
    }
    while (entries_.size() > kMostEntries)
        forget(std::prev(entries_.end()));
}

} // namespace server
