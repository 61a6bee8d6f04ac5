// SPDX-License-Identifier: Apache-2.0
//
// node hashes_test.mjs PACKAGE_FOLDER...: type hashes are those that ROS 2 itself has of its messages
// (those of Jazzy, as its packages and peers of it give them), and our package lists what we publish.
import assert from 'node:assert/strict'
import { test } from 'node:test'
import { load, type_hash } from './messages.mjs'

const messages = load(process.argv.slice(2))
const published = {
  'std_msgs/msg/String': 'RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18',
  'std_msgs/msg/Header': 'RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01',
  'geometry_msgs/msg/PoseStamped': 'RIHS01_10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8',
  'sensor_msgs/msg/NavSatFix': 'RIHS01_62223ab3fe210a15976021da7afddc9e200dc9ec75231c1b6a557fc598a65404',
  'nav_msgs/msg/Path': 'RIHS01_1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b',
  'rmw_dds_common/msg/ParticipantEntitiesInfo': 'RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e',
}

for (const [name, hash] of Object.entries(published)) {
  test(name, () => assert.equal(type_hash(messages.get(name), messages), hash))
}

test('a changed field is another type', () => {
  const changed = structuredClone(messages.get('sensor_msgs/msg/NavSatFix'))
  changed.fields[2].name = 'latitude_deg'
  assert.notEqual(type_hash(changed, messages), published['sensor_msgs/msg/NavSatFix'])
})
