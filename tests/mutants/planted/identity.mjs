// SPDX-License-Identifier: Apache-2.0
// Who may say what: keys, signatures, and what is said again.

const signing = 'runtime/identity/signing.cpp';

export default [
  {
    name: 'start-not-signed',
    slip: 'the start of a sender is not part of what it signs',
    promise: 'a signature holds for one message of one start',
    file: signing,
    from: 'out.number(statement.sender.value, 2).number(statement.instance.value, 8);',
    to: 'out.number(statement.sender.value, 2);',
  },
  {
    name: 'approval-without-an-end',
    slip: 'an operator\'s approval does not cover until when it holds',
    promise: 'an approval is signed with all that it allows',
    file: signing,
    from: `      .number(ns(approval.from), 8)
      .number(ns(approval.until), 8);`,
    to: '      .number(ns(approval.from), 8);',
  },
  {
    name: 'revoked-key-believed',
    slip: 'what was signed with a revoked key is believed, where its certificate is known already',
    promise: 'who was put out says nothing more',
    file: signing,
    from: `  if (revoked_.contains(by.serial)) return Trust::revoked;
  return ed25519_verify`,
    to: '  return ed25519_verify',
  },
  {
    name: 'certificate-of-another-mission',
    slip: 'of operators\' certificates the mission is not asked for',
    promise: 'a member is of one mission',
    file: 'runtime/identity/certificate.cpp',
    from: 'if (certificate.mission != authority.mission) return Trust::other_mission;',
    to: `if (certificate.mission != authority.mission && certificate.role != Role::op) {
    return Trust::other_mission;
  }`,
  },
  {
    name: 'newest-message-again',
    slip: 'the newest message is taken a second time',
    promise: 'no decision counts twice',
    file: 'runtime/network/signatures.cpp',
    from: 'std::pair{instance, sequence} <= std::pair{known->second.instance, known->second.sequence}) {',
    to: 'std::pair{instance, sequence} < std::pair{known->second.instance, known->second.sequence}) {',
  },
  {
    name: 'replay-start-number',
    slip: 'of a sender that has started anew, what an earlier start had sealed is opened',
    promise: 'what an older start said is over',
    file: 'runtime/seal/opener.cpp',
    from: 'if (header.from.number < node->second.number) return Opened::old_start;',
    to: 'if (header.from.number + 1 < node->second.number) return Opened::old_start;',
  },
  {
    name: 'old-epoch-after-the-new',
    slip: 'a start that is unknown is opened under the key of before, although its sender has the new one',
    promise: 'who has only the old key says nothing for who has the new one',
    file: 'runtime/seal/opener.cpp',
    from: 'if (header.epoch < node->second.newest_epoch) return Opened::old_start;',
    to: 'if (header.epoch + 1 < node->second.newest_epoch) return Opened::old_start;',
  },
];
