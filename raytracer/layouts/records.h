/* The records of the section of nodes, and their numbers (header.node_layout). For the TPs and the host. */
#ifndef TRAX_LAYOUTS_RECORDS_H
#define TRAX_LAYOUTS_RECORDS_H

#include "trax/scene_format.h"

#define LAYOUT_FILE "record.h"
#include "table.def"

enum trax_node_layout {
#define LAYOUT(number, NAME, ...) TRAX_NODES_##NAME = number,
#include "table.def"
#define LAYOUT(...) +1
  TRAX_NODE_LAYOUTS = 0
#include "table.def"
};

#endif
