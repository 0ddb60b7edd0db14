// The file desk: how the importer gets the files that a mesh names. It asks by name over a socket; the service
// answers with an open descriptor, or that there is none. So exactly the files that are needed are opened, and
// it is the service, not the importer, that knows which.
//
// Safety  this is how the importer behaves, not what it is held to: one that a file has taken over may still
//         open what the service's user may (see lockdown.h).
// Errors  the importer's side treats a closed desk as "there is none"; the service's side answers what it
//         does not understand the same way, and closes after kMostQuestions.
#pragma once

#include "server/store/file_descriptor.h"

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace server {

constexpr std::size_t kLongestFileName = 1024;
constexpr int kMostQuestions = 256;

// A connected pair: .first stays with the service, .second goes to the importer. Throws std::system_error.
std::pair<FileDescriptor, FileDescriptor> make_desk();

// The importer's side: an open descriptor, or none.
FileDescriptor ask_for_file(int desk, std::string_view name);

// The service's side: answers one question if there is one; `open` gives the descriptor or none. False once
// the other side is gone.
bool answer_question(int desk, const std::function<FileDescriptor(std::string_view name)>& open);

} // namespace server
