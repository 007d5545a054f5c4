import type { ActivityPanel } from '../../activity/activity';
import type { ActivityContext } from '../../activity/activity-context';
import { MatchBar } from './match-bar';
import { barActions, barState, type ControlledMatch, invitingHash } from './match-controls';

/** Creates a match's part of the play bar: its buttons act on the match and on the page. */
export function createMatchPanel(match: ControlledMatch, context: ActivityContext): ActivityPanel {
  const actions = barActions(match, context);
  if (location.hash === invitingHash) {
    history.replaceState(null, '', `${location.pathname}${location.search}`);
    actions.invite();
  }
  return () => {
    if (!context.study.run) void context.server.whenKnown();
    return <MatchBar game={match.game} actions={actions} state={barState(match, context)} />;
  };
}
