// StoredPictures: the picture of a job that succeeded, or a layer beside it, in the encoding that is asked for: from
// memory, from disk, or encoded now from the film that is kept; where the disk lost it, the job renders again.
//
// A picture is found to be lost (missing, cut off, other bytes) when it is asked for. Its job then goes back
// to the queue, and says so, rather than staying succeeded with nothing to show. What was rendered to a number
// of samples renders to the same bytes; what time stopped, to another picture as good. Where a mesh that it
// takes is gone as well, the job stays as it is, its report is still right, and the answer names the mesh.
// Cost     the PNG of 8 bits is kept as it is sent; others are encoded once and stay in the cache while they
//          fit. Two at most are encoded at once, each with blob, film and file in memory.
// Threads  every function may be called from any thread.
// Errors   a lost picture is a value; StoreError is thrown where the disk cannot tell, or the job store fails.
#pragma once

#include "api/problem.h"
#include "renderer/description/picture_formats.h"
#include "server/jobs/encoding_turns.h"
#include "server/jobs/live_jobs.h"
#include "server/jobs/picture_cache.h"
#include "server/jobs/result_keeper.h"
#include "server/log/log.h"
#include "server/store/blob_store.h"
#include "server/store/store.h"

#include <optional>
#include <string>
#include <variant>

namespace server {

class StoredPictures {
public:
    struct Rooms {
        Store& store;
        BlobStore& blobs;
        LiveJobs& live;
        PictureCache& pictures;
        ResultKeeper& keeper;
        Log log;
    };
    explicit StoredPictures(const Rooms& rooms) : rooms_(rooms) {}

    using Answer = std::variant<EncodedPicture, api::ProblemDetails>;

    // `kept`: the blob, where it is still in memory. `digest`: its name, that the job succeeded with.
    Answer get(const JobId& id,
               const std::string& digest,
               const PictureBytes& kept,
               const renderer::PictureEncoding& encoding,
               std::optional<renderer::Layer> layer = {}); // else the picture

private:
    static constexpr std::size_t kEncodedAtOnce = 2;

    std::variant<PictureBytes, api::ProblemDetails> blob(const JobId& id, const std::string& digest);
    PictureBytes read(const std::string& digest, std::string& why_not);
    api::ProblemDetails render_again(const JobId& id, const std::string& digest, const std::string& why);

    Rooms rooms_;
    EncodingTurns turns_{kEncodedAtOnce};
};

} // namespace server
