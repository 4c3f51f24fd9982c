// Counts the buffers and queues that this process makes: the test program's functions of these names come before those
// of the OpenCL loader, and hand over to them.
#pragma once

struct MadeObjects {
  int buffers = 0;
  int queues = 0;
  bool operator==(const MadeObjects&) const = default;
};

/// What was made since the program began.
MadeObjects made_objects();
