// "threepoint-rooms/internal/three": the drawing of a room that the page of this repository uses. It is not published.
export { RoomBodies } from './room-bodies';
