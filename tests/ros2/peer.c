// SPDX-License-Identifier: Apache-2.0
//
// A program of ROS 2 as far as the wire goes, by Cyclone DDS, with nothing of ours in it:
//   peer DOMAIN TYPE=TOPIC...
// reads those topics with the QoS that ROS 2 programs use, and says each message, and what each writer has
// as USER_DATA, as a line of JSON. A line "LATITUDE LONGITUDE KIND NAME" on its input is a SiteProposal to
// rt/skein/site_proposal. It ends with its input.
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "dds/dds.h"
#include "ros2.h"

static void say_text(const char* text) {
  putchar('"');
  for (; text != NULL && *text != '\0'; ++text) {
    const unsigned char c = (unsigned char)*text;
    if (c == '"' || c == '\\') {
      printf("\\%c", c);
    } else if (c < ' ') {
      printf("\\u%04x", c);
    } else {
      putchar(c);
    }
  }
  putchar('"');
}
static void say_named(const char* name, const char* text) {
  printf(",\"%s\":", name);
  say_text(text);
}
static void say_number(const char* name, double value) {
  if (isfinite(value)) {
    printf(",\"%s\":%.17g", name, value);
  } else {
    printf(",\"%s\":null", name);
  }
}
static void say_header(const std_msgs_msg_dds__Header_* header) {
  printf("\"stamp\":%.9f", (double)header->stamp.sec + 1e-9 * (double)header->stamp.nanosec);
  say_named("frame_id", header->frame_id);
}

static void say_fix(const void* data) {
  const sensor_msgs_msg_dds__NavSatFix_* fix = data;
  say_header(&fix->header);
  say_number("status", fix->status.status);
  say_number("service", fix->status.service);
  say_number("latitude", fix->latitude);
  say_number("longitude", fix->longitude);
  say_number("altitude", fix->altitude);
  say_number("position_covariance_type", fix->position_covariance_type);
}
static void say_status(const void* data) {
  const skein_msgs_msg_dds__VehicleStatus_* status = data;
  say_header(&status->header);
  say_number("id", status->id);
  printf(",\"silent\":%s", status->silent ? "true" : "false");
  say_named("activity", status->activity);
  say_named("state", status->state);
  say_number("latitude", status->latitude);
  say_number("longitude", status->longitude);
  say_number("altitude", status->altitude);
  say_number("x", status->position.x);
  say_number("y", status->position.y);
  say_number("z", status->position.z);
  say_number("heading_deg", status->heading_deg);
  say_number("groundspeed", status->groundspeed);
  say_number("range_left", status->range_left);
  say_number("problems", status->problems._length);
}
static void say_path(const void* data) {
  const nav_msgs_msg_dds__Path_* path = data;
  say_header(&path->header);
  printf(",\"poses\":[");
  for (uint32_t i = 0; i < path->poses._length; ++i) {
    const geometry_msgs_msg_dds__PoseStamped_* pose = &path->poses._buffer[i];
    printf("%s{", i == 0 ? "" : ",");
    say_header(&pose->header);
    say_number("x", pose->pose.position.x);
    say_number("y", pose->pose.position.y);
    putchar('}');
  }
  putchar(']');
}
static void say_sites(const void* data) {
  const skein_msgs_msg_dds__Sites_* sites = data;
  say_header(&sites->header);
  printf(",\"sites\":[");
  for (uint32_t i = 0; i < sites->sites._length; ++i) {
    const skein_msgs_msg_dds__Site_* site = &sites->sites._buffer[i];
    printf("%s{\"id\":%u", i == 0 ? "" : ",", site->id);
    say_named("status", site->status);
    say_number("latitude", site->latitude);
    say_number("longitude", site->longitude);
    say_number("tasks", site->tasks._length);
    say_named("first_task", site->tasks._length > 0 ? site->tasks._buffer[0].kind : "");
    putchar('}');
  }
  putchar(']');
}
static void say_hazards(const void* data) {
  const skein_msgs_msg_dds__Hazards_* hazards = data;
  say_header(&hazards->header);
  printf(",\"hazards\":[");
  for (uint32_t i = 0; i < hazards->hazards._length; ++i) {
    const skein_msgs_msg_dds__Hazard_* hazard = &hazards->hazards._buffer[i];
    printf("%s{\"id\":%u", i == 0 ? "" : ",", hazard->id);
    say_number("latitude", hazard->latitude);
    say_number("longitude", hazard->longitude);
    say_number("radius", hazard->radius);
    putchar('}');
  }
  putchar(']');
}
static void say_event(const void* data) {
  const skein_msgs_msg_dds__Event_* event = data;
  say_header(&event->header);
  printf(",\"seq\":%" PRIu64, event->seq);
  say_number("vehicle", event->vehicle);
  say_number("level", event->level);
  say_number("site", event->site);
  say_named("kind", event->kind);
  say_named("text", event->text);
}
static void say_gids(const char* name, const dds_sequence_rmw_dds_common_msg_dds__Gid_* gids) {
  printf(",\"%s\":[", name);
  for (uint32_t i = 0; i < gids->_length; ++i) {
    printf("%s\"", i == 0 ? "" : ",");
    for (int j = 0; j < 16; ++j) printf("%02x", gids->_buffer[i].data[j]);
    putchar('"');
  }
  putchar(']');
}
static void say_graph(const void* data) {
  const rmw_dds_common_msg_dds__ParticipantEntitiesInfo_* graph = data;
  printf("\"nodes\":[");
  for (uint32_t i = 0; i < graph->node_entities_info_seq._length; ++i) {
    const rmw_dds_common_msg_dds__NodeEntitiesInfo_* node = &graph->node_entities_info_seq._buffer[i];
    printf("%s{\"nth\":%u", i == 0 ? "" : ",", i);
    say_named("namespace", node->node_namespace);
    say_named("name", node->node_name);
    say_gids("readers", &node->reader_gid_seq);
    say_gids("writers", &node->writer_gid_seq);
    putchar('}');
  }
  putchar(']');
}

struct type {
  const char* name;
  const dds_topic_descriptor_t* descriptor;
  void (*say)(const void* data);
  int reliable;  // and transient local; otherwise as rclcpp::SensorDataQoS
};
static const struct type kTypes[] = {
    {"NavSatFix", &sensor_msgs_msg_dds__NavSatFix__desc, say_fix, 0},
    {"Origin", &sensor_msgs_msg_dds__NavSatFix__desc, say_fix, 1},
    {"VehicleStatus", &skein_msgs_msg_dds__VehicleStatus__desc, say_status, 0},
    {"Path", &nav_msgs_msg_dds__Path__desc, say_path, 1},
    {"Sites", &skein_msgs_msg_dds__Sites__desc, say_sites, 1},
    {"Hazards", &skein_msgs_msg_dds__Hazards__desc, say_hazards, 1},
    {"Event", &skein_msgs_msg_dds__Event__desc, say_event, 1},
    {"ParticipantEntitiesInfo", &rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc, say_graph, 1},
};

static dds_entity_t checked(dds_entity_t made, const char* what) {
  if (made >= 0) return made;
  fprintf(stderr, "peer: %s: %s\n", what, dds_strretcode(-made));
  exit(1);
}

static dds_qos_t* qos_of(int reliable) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, DDS_SECS(1));
  dds_qset_durability(qos, reliable ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, reliable ? 1000 : 5);
  return qos;
}

struct subscription {
  const char* topic;
  const struct type* type;
  dds_entity_t reader;
  size_t matched;
};

static void say_writers(struct subscription* one) {
  dds_instance_handle_t handles[8];
  const dds_return_t count = dds_get_matched_publications(one->reader, handles, 8);
  if (count < 0 || (size_t)count == one->matched) return;
  one->matched = (size_t)count;
  for (dds_return_t i = 0; i < count && i < 8; ++i) {
    dds_builtintopic_endpoint_t* writer = dds_get_matched_publication_data(one->reader, handles[i]);
    if (writer == NULL) continue;
    void* data = NULL;
    size_t size = 0;
    char text[256] = "";
    if (dds_qget_userdata(writer->qos, &data, &size) && size < sizeof text) memcpy(text, data, size);
    printf("{\"writer_of\":");
    say_text(one->topic);
    say_named("type_name", writer->type_name);
    say_named("user_data", text);
    printf(",\"gid\":\"");
    for (int j = 0; j < 16; ++j) printf("%02x", writer->key.v[j]);
    printf("\"}\n");
    dds_free(data);
    dds_builtintopic_free_endpoint(writer);
  }
}

static void say_messages(struct subscription* one) {
  void* samples[1] = {NULL};
  dds_sample_info_t info;
  while (dds_take(one->reader, samples, &info, 1, 1) > 0) {
    if (info.valid_data) {
      struct timespec now;
      clock_gettime(CLOCK_REALTIME, &now);
      printf("{\"topic\":");
      say_text(one->topic);
      printf(",\"at\":%.6f,\"message\":{", (double)now.tv_sec + 1e-9 * (double)now.tv_nsec);
      one->type->say(samples[0]);
      printf("}}\n");
    }
    dds_return_loan(one->reader, samples, 1);
  }
}

static void propose(dds_entity_t writer, const char* line) {
  skein_msgs_msg_dds__SiteProposal_ proposal;
  int kind = 0;
  char name[200] = "";
  if (sscanf(line, "%lf %lf %d %199[^\n]", &proposal.latitude, &proposal.longitude, &kind, name) < 3) return;
  proposal.kind = (uint8_t)kind;
  proposal.name = name;
  dds_write(writer, &proposal);
}

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  setvbuf(stdout, NULL, _IOLBF, 0);
  setvbuf(stdin, NULL, _IONBF, 0);  // so that poll() sees all that is left
  const dds_entity_t participant =
      checked(dds_create_participant((dds_domainid_t)atoi(argv[1]), NULL, NULL), "participant");
  struct subscription* all = calloc((size_t)argc, sizeof *all);
  const int count = argc - 2;
  for (int i = 0; i < count; ++i) {
    char* equals = strchr(argv[2 + i], '=');
    if (equals == NULL) return 2;
    *equals = '\0';
    for (size_t j = 0; j < sizeof kTypes / sizeof kTypes[0]; ++j) {
      if (strcmp(kTypes[j].name, argv[2 + i]) == 0) all[i].type = &kTypes[j];
    }
    if (all[i].type == NULL) return 2;
    all[i].topic = equals + 1;
    const dds_entity_t topic =
        checked(dds_create_topic(participant, all[i].type->descriptor, all[i].topic, NULL, NULL), all[i].topic);
    dds_qos_t* qos = qos_of(all[i].type->reliable);
    all[i].reader = checked(dds_create_reader(participant, topic, qos, NULL), all[i].topic);
    dds_delete_qos(qos);
  }
  // As rclcpp publishes by default: reliable, volatile.
  const dds_entity_t topic = checked(
      dds_create_topic(participant, &skein_msgs_msg_dds__SiteProposal__desc, "rt/skein/site_proposal", NULL, NULL),
      "site_proposal");
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 10);
  const dds_entity_t writer = checked(dds_create_writer(participant, topic, qos, NULL), "site_proposal");
  dds_delete_qos(qos);

  int told = 0;
  for (;;) {
    for (int i = 0; i < count; ++i) {
      say_writers(&all[i]);
      say_messages(&all[i]);
    }
    dds_publication_matched_status_t matched;
    if (!told && dds_get_publication_matched_status(writer, &matched) == 0 && matched.current_count > 0) {
      printf("{\"proposals\":true}\n");
      told = 1;
    }
    struct pollfd input = {STDIN_FILENO, POLLIN, 0};
    if (poll(&input, 1, 5) <= 0) continue;
    char line[512];
    if (fgets(line, sizeof line, stdin) == NULL) break;
    propose(writer, line);
  }
  dds_delete(participant);
  free(all);
  return 0;
}
