// Sharing: whether a job may take the picture of another with the same render key instead of rendering.
#pragma once

#include "api/job_request.h"

#include <string>

namespace server {

struct Sharing {
    std::string render_key;
    bool takes_results = true;        // of others
    bool fails_on_non_finite = false; // takes only results without such samples
};

Sharing sharing_of(const api::JobRequest& request, std::string render_key, bool no_cache);

// Of a stored result, it is not known how many samples were not finite.
bool may_reuse_stored(const Sharing& sharing);

} // namespace server
