/** Texts that are no packets of socket.io because of what they carry: its server assumes that a parser refuses them. */
export const noPackets: readonly string[] = [
  '0["/",null]',
  '0["/lobby",null]',
  '0["/",[]]',
  '0["/","token"]',
  '0["/",7]',
  '1["/",{}]',
  '2["/",["disconnect"]]',
  '2["/",["disconnecting"]]',
  '2["/",["connect"]]',
  '2["/",["connect_error"]]',
  '2["/",["newListener"]]',
  '2["/",["removeListener"]]',
  '0["/",{},1]',
  '3["/",[]]',
];
