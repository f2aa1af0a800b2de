// Writes a growing map to its file in a thread of its own.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "fovea/core/bounded_queue.h"
#include "fovea/map/frame_record.h"
#include "fovea/map/map_store.h"
#include "fovea/map/tile_map.h"

namespace fovea {

/// Content of a checkpoint other than tiles.
struct MapRows {
  MapMeta meta;
  std::vector<DriveRecord> drives;    ///< by number; empty: no change
  std::vector<SensorRecord> sensors;  ///< by number; empty: no change
  std::vector<FrameRecord> frames;
  std::vector<KeyframeRecord> keyframes;
  std::vector<std::pair<int, RigidMotion>> poses;  ///< T_local_lidar of frames written before
  std::vector<std::pair<std::size_t, SubmapRecord>> submaps;
  std::vector<std::pair<std::string, CheckpointRecord>> states;  ///< by name
};

struct CheckpointerOptions {
  bool threaded = true;  ///< false: checkpoint() itself writes
  /// Bytes that the process should keep to. Near them, each checkpoint gives the allocator's free
  /// memory back to the system.
  std::size_t memory = std::size_t{1} << 30;
  /// Commits nothing before finish(), for a map that is of use only when complete.
  bool commit_at_end = false;
  /// Called by checkpoint() and finish() with what they are about to write. All earlier checkpoints
  /// are committed.
  std::function<void(const TileChanges&, const MapRows&)> on_checkpoint = {};
};

/// Each checkpoint is one transaction: after a crash the file has the state of the last committed
/// one. The number and the times of the checkpoints do not change the map.
///
/// A background thread, "fovea-write", takes tasks from a queue: rows, snapshots of tiles, a
/// commit. Reads of tiles go before them.
class Checkpointer {
 public:
  Checkpointer(std::unique_ptr<MapWriter> writer, const CheckpointerOptions& options);
  /// Writes and commits the queued checkpoint. An error of that is not reported: wait() reports it.
  ~Checkpointer();

  /// Queues all changes since the last checkpoint. First waits for the checkpoint before.
  /// Throws the error of an earlier checkpoint, e.g. OutputError of a full disk.
  void checkpoint(TileMap& map, MapRows rows);
  /// Whether the latest checkpoint is still being written.
  bool is_writing() const;
  /// Waits until the latest checkpoint is written. Throws its error.
  void wait();
  /// Writes the last changes with all threads, and MapWriter::finish(). No other call may follow.
  /// Without an observer, the same transaction has the rest of the latest checkpoint.
  void finish(TileMap& map, MapRows rows);

  /// Reads a tile that an earlier run or a finished checkpoint wrote, before the queued tasks of
  /// checkpoints. The future throws InputError if the file is damaged, or the error of an earlier
  /// task. After an error no task is performed, and finish() throws the error.
  std::future<TilePoints> read_tile(const TileId& id);

 private:
  struct ChangedRows {
    MapRows rows;
    std::vector<TileId> removed;
  };
  using TileSnapshot = TileChanges::Changed;
  struct Commit {
    std::promise<void> done;
  };
  struct TileRead {
    TileId id;
    std::promise<TilePoints> points;
  };
  using Task = std::variant<ChangedRows, TileSnapshot, Commit, TileRead>;

  TileChanges take_changes(TileMap& map, const MapRows& rows) const;
  void queue(Task task);
  void write(const ChangedRows& changed);

  // Run in the writer thread; without threads, in the caller's.
  void perform(Task& task);
  void perform(ChangedRows& changed);
  void perform(TileSnapshot& tile);
  void perform(Commit& commit);
  void perform(TileRead& read);
  /// The first error is kept, and ends all writing and reading.
  template <class Step>
  void unless_failed(Step&& step);

  CheckpointerOptions options_;
  std::unique_ptr<MapWriter> writer_;  // only the writer thread uses it, until finish() has joined
  std::exception_ptr error_;           // likewise
  std::future<void> written_;          // of the latest checkpoint
  BoundedQueue<Task> tasks_;
  std::jthread thread_;  // last: uses all of the above
};

}  // namespace fovea
